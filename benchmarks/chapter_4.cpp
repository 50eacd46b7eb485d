// Chapter 4 of the dissertation on a collection of genus-zero meshes in folders of classes:
// spherical normal, curvature and geometry images compared, levels of detail on a self-organizing
// map, poses of cuboids. Writes Markdown to standard output.
//   shape3d_chapter_4 COLLECTION DETAILED.off…
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <tbb/parallel_for.h>
#include <Eigen/Geometry>
#include <shape3d/descriptors/descriptor.hpp>
#include <shape3d/learning/distance.hpp>
#include <shape3d/learning/retrieval.hpp>
#include <shape3d/learning/som.hpp>
#include <shape3d/mapping/align.hpp>
#include <shape3d/mapping/inspect.hpp>
#include <shape3d/mapping/progressive.hpp>
#include <shape3d/mapping/repair.hpp>
#include <shape3d/mapping/spherical_map.hpp>

#include "collection.hpp"
#include "common/mesh_io.hpp"
#include "markdown_table.hpp"

namespace {
using namespace shape3d;
using bench::fixed;
using bench::MarkdownTable;
using descriptors::Descriptor;
using learning::Features;
using learning::Labels;
using mapping::Points;
using mapping::Triangles;

struct Image {
  const char* name;
  const char* kind;
};
constexpr Image kImages[] = {{"SNI", "sni"}, {"SCI", "sci"}, {"SGI", "sgi"}};
constexpr const char* kForms[] = {"amplitudes", "norms"};

struct ClosedMesh {
  Points V;
  Triangles F;
};

/// A mesh in its pose with its map; empty S and a reason when it cannot be mapped.
struct Mapped {
  Points V, S;
  Triangles F;
  std::string why_not;
  bool repaired = false, ambiguous = false;
  int divisions =
      0;  ///< Times that its triangles were divided into four, so that it could be mapped.
};

/// Every triangle as four: the same surface.
ClosedMesh divided(const ClosedMesh& mesh) {
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::RowVector3d> added;
  const auto middle = [&](int i, int j) {
    const auto [place, fresh] = middles.emplace(
        std::minmax(i, j), static_cast<int>(mesh.V.rows()) + static_cast<int>(added.size()));
    if (fresh) added.emplace_back(0.5 * (mesh.V.row(i) + mesh.V.row(j)));
    return place->second;
  };
  ClosedMesh result;
  result.F.resize(4 * mesh.F.rows(), 3);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const int a = mesh.F(t, 0), b = mesh.F(t, 1), c = mesh.F(t, 2);
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    result.F.middleRows<4>(4 * t) << a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca;
  }
  result.V.resize(mesh.V.rows() + static_cast<Eigen::Index>(added.size()), 3);
  result.V.topRows(mesh.V.rows()) = mesh.V;
  for (std::size_t k = 0; k < added.size(); ++k) {
    result.V.row(mesh.V.rows() + static_cast<Eigen::Index>(k)) = added[k];
  }
  return result;
}

Mapped mapped(ClosedMesh mesh) {
  Mapped result;
  const mapping::Inspection inspection = mapping::inspect(mesh.V, mesh.F);
  if (!inspection.spherical()) {
    mapping::Repaired repaired = mapping::repair(mesh.V, mesh.F);
    result.repaired = true;
    if (!repaired.after.spherical()) {
      result.why_not = repaired.after.why_not_spherical("repair", "wrap");
      return result;
    }
    mesh = {repaired.V, repaired.F};
  }
  const mapping::Pose pose = mapping::align(mesh.V, mesh.F);
  result.ambiguous = pose.ambiguous;
  mesh.V = mapping::posed(mesh.V, pose);
  // Limbs of few triangles may be too coarse for a map that is one to one.
  for (; result.divisions <= 1; ++result.divisions, mesh = divided(mesh)) {
    mapping::SphericalMap map = mapping::spherical_map(mesh.V, mesh.F);
    if (map.status == mapping::Status::certified) {
      result.S = std::move(map.S);
      result.V = std::move(mesh.V);
      result.F = std::move(mesh.F);
      return result;
    }
    result.why_not = mapping::to_string(map.status);
  }
  return result;
}

constexpr int kDegree = 16;
constexpr int kAmplitudes = (kDegree + 1) * (kDegree + 2) / 2;  // of a component

/// Both forms of the vector of an image from one expansion: the amplitudes of all components, of
/// which the dissertation takes the first two, and the norms, which follow from them.
std::map<std::string, Eigen::VectorXd> vectors(const Image& image, const Mapped& mesh) {
  const bool scalar = std::string(image.kind) == "sci";
  const Descriptor d = Descriptor::parse(std::string(image.kind) + ":K=16,form=amplitudes" +
                                         (scalar ? "" : ",components=3"));
  const Eigen::VectorXd all = d.compute(mesh.V, mesh.F, mesh.S, 1);
  Eigen::VectorXd norms = Eigen::VectorXd::Zero(kDegree + 1);
  for (Eigen::Index k = 0; k < all.size(); ++k) {
    int l = 0, m = static_cast<int>(k % kAmplitudes);
    while (m > l) m -= ++l;
    norms[l] += (m == 0 ? 1 : 2) * all[k] * all[k];  // |C_l^-m| = |C_l^m|
  }
  return {{"amplitudes", all.head(scalar ? kAmplitudes : 2 * kAmplitudes)},
          {"norms", norms.cwiseSqrt()}};
}

using FeatureSets = std::map<std::string, Features>;  // by "kind form"

std::string name_of(const Image& image, const std::string& form) {
  return std::string(image.kind) + " " + form;
}

FeatureSets features(const std::vector<Mapped>& meshes) {
  FeatureSets sets;
  for (const Image& image : kImages) {
    std::vector<std::map<std::string, Eigen::VectorXd>> rows(meshes.size());
    tbb::parallel_for(std::size_t{0}, meshes.size(),
                      [&](std::size_t i) { rows[i] = vectors(image, meshes[i]); });
    for (const char* form : kForms) {
      Features& X = sets[name_of(image, form)];
      X.resize(static_cast<Eigen::Index>(meshes.size()), rows.front()[form].size());
      for (std::size_t i = 0; i < rows.size(); ++i) {
        X.row(static_cast<Eigen::Index>(i)) = rows[i][form].transpose();
      }
    }
    std::fprintf(stderr, "%s: %zu described\n", image.name, meshes.size());
  }
  return sets;
}

Eigen::MatrixXd distances(const Features& X) {
  Eigen::MatrixXd D(X.rows(), X.rows());
  for (Eigen::Index i = 0; i < X.rows(); ++i) {
    D.row(i) = (X.rowwise() - X.row(i)).rowwise().norm().transpose();
  }
  return D;
}

/// Share of the items whose class is that of most of the k nearest others; of equally many, the
/// nearest one's.
double vote_rate(const Eigen::MatrixXd& D, const Labels& labels, int k) {
  int right = 0;
  for (Eigen::Index i = 0; i < D.rows(); ++i) {
    std::vector<int> others;
    for (int j = 0; j < D.cols(); ++j) {
      if (j != i) others.push_back(j);
    }
    std::stable_sort(others.begin(), others.end(), [&](int a, int b) { return D(i, a) < D(i, b); });
    std::map<int, int> votes;
    for (int n = 0; n < k; ++n) ++votes[labels[others[n]]];
    int most = 0, winner = -1;
    for (int n = 0; n < k; ++n) {
      const int label = labels[others[n]];
      if (votes[label] > most) {
        most = votes[label];
        winner = label;
      }
    }
    right += winner == labels[static_cast<std::size_t>(i)] ? 1 : 0;
  }
  return right / static_cast<double>(D.rows());
}

learning::Som trained(const Features& X, std::uint64_t seed) {
  learning::SomOptions options;  // 12 by 6
  options.seed = seed;
  options.start = seed == 0 ? learning::SomStart::pca : learning::SomStart::random;
  return learning::train_som(X, options);
}

/// Share of the items that are of the class of most in their unit.
double purity(const std::vector<int>& units, const Labels& labels) {
  std::map<int, std::map<int, int>> counts;
  for (std::size_t i = 0; i < units.size(); ++i) ++counts[units[i]][labels[i]];
  int pure = 0;
  for (const auto& [unit, classes] : counts) {
    int most = 0;
    for (const auto& [label, count] : classes) most = std::max(most, count);
    pure += most;
  }
  return pure / static_cast<double>(units.size());
}

struct Spread {
  double mean = 0, deviation = 0;
};

Spread spread(const std::vector<double>& values) {
  Spread s;
  for (const double v : values) s.mean += v / static_cast<double>(values.size());
  for (const double v : values) s.deviation += (v - s.mean) * (v - s.mean);
  s.deviation = std::sqrt(s.deviation / static_cast<double>(values.size() - 1));
  return s;
}

std::string percent(double share) { return fixed(100 * share, 1); }

void compare_images(const FeatureSets& sets, const Labels& labels) {
  MarkdownTable table({"image", "numbers of", "length", "nearest neighbour", "3 nearest",
                       "5 nearest", "first tier", "DCG", "SOM purity, PCA start",
                       "SOM purity, 10 random starts", "purity of shuffled classes"});
  std::mt19937 random(1);
  for (const char* form : kForms) {
    for (const Image& image : kImages) {
      const Features& X = sets.at(name_of(image, form));
      const Eigen::MatrixXd D = distances(X);
      const auto retrieval = learning::evaluate_retrieval(D, labels).micro.measures;
      const std::vector<int> units = learning::best_units(trained(X, 0), X).first;
      std::vector<double> random_starts, shuffled;
      for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        random_starts.push_back(purity(learning::best_units(trained(X, seed), X).first, labels));
        Labels other = labels;
        std::shuffle(other.begin(), other.end(), random);
        shuffled.push_back(purity(units, other));
      }
      const Spread starts = spread(random_starts), chance = spread(shuffled);
      table.add({image.name, form, std::to_string(X.cols()), percent(retrieval.nearest_neighbour),
                 percent(vote_rate(D, labels, 3)), percent(vote_rate(D, labels, 5)),
                 percent(retrieval.first_tier), percent(retrieval.dcg),
                 percent(purity(units, labels)),
                 percent(starts.mean) + " ± " + percent(starts.deviation), percent(chance.mean)});
    }
  }
  std::printf("## Images compared\n\n%s\n", table.text().c_str());
  std::fflush(stdout);
}

/// Distance on the grid in steps between neighbouring units.
int steps(const learning::SomGrid& grid, int from, int to) {
  const auto neighbours = learning::som_neighbours(grid);
  std::vector<int> distance(neighbours.size(), -1), front{from};
  distance[from] = 0;
  for (std::size_t k = 0; k < front.size(); ++k) {
    for (const int u : neighbours[front[k]]) {
      if (distance[u] >= 0) continue;
      distance[u] = distance[front[k]] + 1;
      front.push_back(u);
    }
  }
  return distance[to];
}

/// Each detailed mesh in 500, 1,000 … triangles.
std::vector<std::vector<Mapped>> levels(const std::vector<std::string>& files) {
  const std::vector<std::int64_t> counts{500, 1000, 2000, 4000, 8000, 16000};
  std::vector<std::vector<Mapped>> result(files.size(), std::vector<Mapped>(counts.size()));
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
    const apps::Mesh mesh = apps::read_mesh(files[i]).mesh;
    mapping::ProgressiveMesh progressive(mesh.V, mesh.F);
    for (std::size_t k = 0; k < counts.size(); ++k) {
      progressive.set_triangle_count(counts[k]);
      result[i][k] = mapped({progressive.V(), progressive.F()});
    }
  });
  return result;
}

void levels_of_detail(const FeatureSets& sets, const std::vector<std::string>& files) {
  const std::vector<std::vector<Mapped>> all_levels = levels(files);
  std::fprintf(stderr, "levels of detail mapped\n");
  for (const Image& image : kImages) {
    for (const char* form : kForms) {
      const learning::Som som = trained(sets.at(name_of(image, form)), 0);
      MarkdownTable table({"mesh", "500", "1,000", "2,000", "4,000", "8,000", "16,000",
                           "most steps from the finest", "largest distance / nearest other mesh"});
      int within = 0, all = 0;
      std::vector<std::vector<Eigen::VectorXd>> found;
      std::vector<std::vector<int>> units;
      for (const std::vector<Mapped>& of_one : all_levels) {
        found.emplace_back();
        units.emplace_back();
        for (const Mapped& level : of_one) {
          if (level.S.rows() == 0) {
            units.back().push_back(-1);
            continue;
          }
          found.back().push_back(vectors(image, level)[form]);
          const Features x = found.back().back().transpose();
          units.back().push_back(learning::best_units(som, x).first.front());
        }
      }
      for (std::size_t i = 0; i < files.size(); ++i) {
        std::vector<std::string> cells{std::filesystem::path(files[i]).stem().string()};
        int most = 0;
        for (const int u : units[i]) {
          cells.push_back(u < 0 ? "–" : std::to_string(u));
          if (u < 0) continue;
          const int away = steps(som.grid, u, units[i].back());
          most = std::max(most, away);
          ++all;
          within += away <= 1 ? 1 : 0;
        }
        double own = 0, other = 1e300;
        for (const Eigen::VectorXd& v : found[i]) {
          own = std::max(own, (v - found[i].back()).norm());
        }
        for (std::size_t j = 0; j < files.size(); ++j) {
          if (j == i) continue;
          other = std::min(other, (found[j].back() - found[i].back()).norm());
        }
        cells.push_back(std::to_string(most));
        cells.push_back(fixed(own / other, 2));
        table.add(cells);
      }
      std::printf(
          "### %s, %s\n\n%s\n%d of %d levels are in the unit of the finest or beside it.\n\n",
          image.name, form, table.text().c_str(), within, all);
      std::fflush(stdout);
    }
  }
}

/// A cuboid of edges a, b, c as n by n quadrangles a face, halved.
ClosedMesh cuboid(double a, double b, double c, int n) {
  std::map<std::array<int, 3>, int> numbers;
  std::vector<std::array<int, 3>> corners;
  std::vector<std::array<int, 3>> triangles;
  const auto number = [&](const std::array<int, 3>& at) {
    const auto [place, added] = numbers.emplace(at, static_cast<int>(corners.size()));
    if (added) corners.push_back(at);
    return place->second;
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, n}) {
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> p{};
            p[axis] = side;
            p[(axis + 1) % 3] = u;
            p[(axis + 2) % 3] = v;
            return number(p);
          };
          std::array<int, 4> q{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          if (side == 0) std::swap(q[1], q[3]);
          triangles.push_back({q[0], q[1], q[2]});
          triangles.push_back({q[0], q[2], q[3]});
        }
      }
    }
  }
  ClosedMesh mesh;
  mesh.V.resize(static_cast<Eigen::Index>(corners.size()), 3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    mesh.V.row(static_cast<Eigen::Index>(i)) << a * corners[i][0] / n, b * corners[i][1] / n,
        c * corners[i][2] / n;
  }
  mesh.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    mesh.F.row(static_cast<Eigen::Index>(t)) << triangles[t][0], triangles[t][1], triangles[t][2];
  }
  return mesh;
}

void poses() {
  MarkdownTable table({"cuboid", "poses", "said to be ambiguous", "mean angle between poses",
                       "most", "SNI amplitudes: spread", "SNI norms: spread"});
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const auto& [a, b, c, name] :
       {std::tuple(1.0, 1.0, 1.0, "1 : 1 : 1"), std::tuple(5.0, 1.0, 1.0, "5 : 1 : 1"),
        std::tuple(5.0, 3.0, 1.0, "5 : 3 : 1")}) {
    const ClosedMesh mesh = cuboid(a, b, c, 12);
    std::vector<Eigen::Matrix3d> left;  // where the cuboid's axes come to lie
    std::vector<Eigen::VectorXd> amplitudes, norms;
    int ambiguous = 0;
    constexpr int kPoses = 20;
    for (int k = 0; k < kPoses; ++k) {
      const Eigen::Matrix3d R =
          Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
              .normalized()
              .toRotationMatrix();
      const ClosedMesh turned{mesh.V * R.transpose(), mesh.F};
      left.push_back(mapping::align(turned.V, turned.F).rotation * R);
      const Mapped m = mapped(turned);
      ambiguous += m.ambiguous ? 1 : 0;
      std::map<std::string, Eigen::VectorXd> both = vectors(kImages[0], m);
      amplitudes.push_back(both["amplitudes"]);
      norms.push_back(both["norms"]);
    }
    // Two poses differ by the least rotation that takes one to the other, up to the half turns that
    // every cuboid has.
    double sum = 0, most = 0;
    int pairs = 0;
    for (int i = 0; i < kPoses; ++i) {
      for (int j = 0; j < i; ++j) {
        const Eigen::Matrix3d Q = left[i] * left[j].transpose();
        double cosine = -1;
        for (const Eigen::Vector3d& turn :
             {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(1, -1, -1), Eigen::Vector3d(-1, 1, -1),
              Eigen::Vector3d(-1, -1, 1)}) {
          cosine = std::max(cosine, (Q.diagonal().dot(turn) - 1) / 2);
        }
        const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 57.29577951308232;
        sum += angle;
        most = std::max(most, angle);
        ++pairs;
      }
    }
    const auto relative_spread = [](const std::vector<Eigen::VectorXd>& of_poses) {
      Eigen::VectorXd mean = Eigen::VectorXd::Zero(of_poses.front().size());
      for (const auto& v : of_poses) mean += v / static_cast<double>(of_poses.size());
      double squares = 0;
      for (const auto& v : of_poses) squares += (v - mean).squaredNorm();
      return std::sqrt(squares / static_cast<double>(of_poses.size())) / mean.norm();
    };
    table.add({name, std::to_string(kPoses), std::to_string(ambiguous), fixed(sum / pairs, 1) + "°",
               fixed(most, 1) + "°", fixed(relative_spread(amplitudes), 4),
               fixed(relative_spread(norms), 4)});
  }
  std::printf(
      "## Poses of cuboids (Fig. 4.9)\n\n%s\n"
      "The spread is the deviation of the vectors about their mean over the length of the mean. "
      "Poses differ by\nthe least rotation between them, up to the half turns that every "
      "cuboid has.\n\n",
      table.text().c_str());
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  if (argc < 2) throw std::invalid_argument("usage: shape3d_chapter_4 COLLECTION DETAILED.off...");
  const apps::Collection collection = apps::folder_collections(argv[1]).train;
  std::vector<Mapped> all(collection.models.size());
  tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
    const apps::Mesh mesh = apps::read_mesh(collection.models[i].path).mesh;
    all[i] = mapped({mesh.V, mesh.F});
  });
  std::vector<Mapped> meshes;
  Labels labels;
  int repaired = 0, ambiguous = 0, divided_once = 0;
  std::map<std::string, int> left_out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    repaired += all[i].repaired ? 1 : 0;
    if (all[i].S.rows() == 0) {
      ++left_out[collection.classes[static_cast<std::size_t>(collection.models[i].of_class)] +
                 ": " + all[i].why_not];
      continue;
    }
    ambiguous += all[i].ambiguous ? 1 : 0;
    divided_once += all[i].divisions == 1 ? 1 : 0;
    labels.push_back(collection.models[i].of_class);
    meshes.push_back(std::move(all[i]));
  }
  std::printf(
      "%zu meshes of %zu classes; %d had to be repaired. %zu are mapped, %d of these with their "
      "triangles divided\ninto four; the poses of %d are ambiguous.\n\n",
      all.size(), collection.classes.size(), repaired, meshes.size(), divided_once, ambiguous);
  MarkdownTable without({"class", "left out because", "meshes"});
  for (const auto& [reason, count] : left_out) {
    const std::size_t colon = reason.find(": ");
    without.add({reason.substr(0, colon), reason.substr(colon + 2), std::to_string(count)});
  }
  if (!left_out.empty()) std::printf("%s\n", without.text().c_str());
  std::fflush(stdout);
  std::fprintf(stderr, "%zu meshes mapped\n", meshes.size());
  const FeatureSets sets = features(meshes);
  compare_images(sets, labels);
  poses();
  std::printf(
      "## One object in 500 to 16,000 triangles\n\nUnits of the map (row · 6 + column).\n\n");
  levels_of_detail(sets, std::vector<std::string>(argv + 2, argv + argc));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "shape3d_chapter_4: %s\n", error.what());
    return 1;
  }
}
