#include "map_view.hpp"
#include "search_view.hpp"
#include "segmentation_view.hpp"
#include "sphere_view.hpp"
#include "surface_view.hpp"
#include "view.hpp"
#include "volume_view.hpp"

namespace shape3d::apps::viewer {

std::vector<View*> make_views(Document& document) {
  return {new VolumeView(document), new SurfaceView(document), new SegmentationView(document),
          new SphereView(document), new SearchView(document),  new MapView(document)};
}

}  // namespace shape3d::apps::viewer
