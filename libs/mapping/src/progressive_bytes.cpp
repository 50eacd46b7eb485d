// The compact form of a progressive mesh:
//   8 bytes of magic; numbers of vertices, triangles, collapses; the form of coordinates;
//   the coarsest level: vertex rows and positions, triangle rows and corners;
//   the splits from coarse to fine;
//   a checksum of everything before.
// A split names the vertex v that it splits, the new vertex u and the new triangles. Their third
// vertices are given by their places among the neighbours of v.
#include <algorithm>
#include <array>

#include "byte_stream.hpp"
#include "position_coder.hpp"
#include "progressive_data.hpp"

namespace shape3d::mapping {
namespace {

using detail::ByteReader;
using detail::ByteWriter;
using detail::CollapsePlace;
using detail::Corner;
using detail::CornerMesh;
using detail::PositionCoder;

constexpr std::uint64_t kMagic = 0x31474F5250443353;  // "S3DPROG1"

std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }

/// The neighbours of a vertex in the order of CornerMesh::turn().
class Ring {
 public:
  Ring(const CornerMesh& mesh, std::int32_t v) : mesh_(mesh) {
    const Corner first = mesh.first_corner(v);
    Corner c = first;
    do {
      corners_.push_back(c);
      c = mesh.turn(c);
    } while (c >= 0 && c != first);
    open_ = c < 0;
  }

  [[nodiscard]] bool open() const { return open_; }
  [[nodiscard]] std::int32_t first_triangle() const { return corners_.front() / 3; }
  [[nodiscard]] std::int32_t size() const {
    return static_cast<std::int32_t>(corners_.size()) + (open_ ? 1 : 0);
  }
  [[nodiscard]] std::int32_t neighbour(std::int32_t place) const {
    return index(place) < corners_.size() ? mesh_.vertex(detail::next(corners_[index(place)]))
                                          : mesh_.vertex(detail::previous(corners_.back()));
  }
  [[nodiscard]] std::int32_t place_of(std::int32_t neighbour_vertex) const {
    for (std::int32_t place = 0; place < size(); ++place)
      if (neighbour(place) == neighbour_vertex) return place;
    return -1;
  }
  /// The corner across the edge from the vertex to a neighbour, in the triangle behind it (that
  /// runs along the edge outwards), and in the one before it; −1: none.
  [[nodiscard]] Corner across_behind(std::int32_t place) const {
    return index(place) < corners_.size() ? detail::previous(corners_[index(place)]) : -1;
  }
  [[nodiscard]] Corner across_before(std::int32_t place) const {
    if (place > 0) return detail::next(corners_[index(place - 1)]);
    return open_ ? -1 : detail::next(corners_.back());
  }

 private:
  const CornerMesh& mesh_;
  std::vector<Corner> corners_;
  bool open_ = false;
};

/// Writes the splits while it makes them.
class Writer {
 public:
  explicit Writer(const ProgressiveMesh::Data& data);

  std::vector<std::byte> run(const Points& V) {
    PositionCoder coder(V, data_.lattice_exponent);
    out_.word(kMagic);
    out_.number(static_cast<std::uint64_t>(data_.P.rows()));
    out_.number(data_.triangle_end.size());
    out_.number(data_.steps.size());
    coder.write_header(out_);
    write_coarsest(coder);
    while (data_.level > 0) write_split(coder);
    const std::vector<std::byte>& bytes = out_.bytes();
    out_.word(detail::checksum(bytes.data(), bytes.size()));
    return out_.take();
  }

 private:
  void write_coarsest(const PositionCoder& coder) {
    Eigen::RowVector3d near = Eigen::RowVector3d::Zero();
    std::int32_t last = -1;
    for (std::int32_t v = 0; index(v) < data_.vertex_end.size(); ++v) {
      if (data_.vertex_end[index(v)] < data_.level) continue;
      out_.number(static_cast<std::uint64_t>(v - last - 1));
      last = v;
      const Eigen::RowVector3d p = data_.P.row(v);
      const PositionCoder::Mode mode = coder.mode_of(p, near);
      out_.byte(static_cast<std::uint8_t>(mode));
      coder.write(out_, mode, p, near);
      near = p;
    }
    out_.number(static_cast<std::uint64_t>(data_.triangles_at.back()));
    last = -1;
    for (std::int32_t t = 0; index(t) < data_.triangle_end.size(); ++t) {
      if (data_.triangle_end[index(t)] < data_.level) continue;
      out_.number(static_cast<std::uint64_t>(t - last - 1));
      last = t;
      for (int i = 0; i < 3; ++i)
        out_.number(static_cast<std::uint64_t>(data_.mesh.vertex(3 * t + i)));
    }
  }

  void write_split(const PositionCoder& coder) {
    const ProgressiveStep& step = data_.steps[index(data_.level - 1)];
    const auto [left, right] = step.place;
    const CornerMesh& mesh = data_.mesh;
    const std::int32_t u = mesh.vertex(left >= 0 ? left : right);
    const std::int32_t v = mesh.vertex(left >= 0 ? detail::next(left) : detail::previous(right));
    const Ring ring(mesh, v);
    const Eigen::RowVector3d near = data_.P.row(v);
    const PositionCoder::Mode kept = coder.mode_of(step.kept_before, near),
                              removed = coder.mode_of(step.removed, near);
    const auto turn = [](Corner c) { return c < 0 ? 3 : c % 3; };
    out_.byte(static_cast<std::uint8_t>(turn(left) | turn(right) << 2 |
                                        static_cast<int>(kept) << 4 |
                                        static_cast<int>(removed) << 6));
    out_.number(static_cast<std::uint64_t>(v));
    out_.signed_number(u - v);
    std::int64_t near_triangle = ring.first_triangle();
    if (left >= 0) {
      out_.signed_number(left / 3 - near_triangle);
      near_triangle = left / 3;
      out_.number(static_cast<std::uint64_t>(ring.place_of(mesh.vertex(detail::previous(left)))));
    }
    if (right >= 0) {
      out_.signed_number(right / 3 - near_triangle);
      out_.number(static_cast<std::uint64_t>(ring.place_of(mesh.vertex(detail::next(right)))));
    }
    coder.write(out_, kept, step.kept_before, near);
    coder.write(out_, removed, step.removed, near);
    data_.refine();
  }

  ProgressiveMesh::Data data_;
  ByteWriter out_;
};

Writer::Writer(const ProgressiveMesh::Data& data) : data_(data) {
  while (data_.level < static_cast<std::int64_t>(data_.steps.size())) data_.coarsen();
}

/// Builds a mesh from bytes, from coarse to fine.
class Reader {
 public:
  Reader(const std::byte* data, std::size_t size) : in_(data, size) {
    if (size < 16 || in_.word() != kMagic) in_.refuse("they do not begin with S3DPROG1");
    ByteReader tail(data + size - 8, 8);
    if (tail.word() != detail::checksum(data, size - 8)) in_.refuse("the checksum does not fit");
    in_ = ByteReader(data, size - 8);
    (void)in_.word();
  }

  std::unique_ptr<ProgressiveMesh::Data> run() {
    const std::int64_t vertices = in_.count(1), triangles = in_.count(1);
    const std::int64_t splits = in_.count(3);
    if (splits > vertices || vertices == 0 || triangles == 0 || triangles > 700000000)
      in_.refuse("its counts do not fit");
    const PositionCoder coder(in_);
    data_ = std::make_unique<ProgressiveMesh::Data>();
    data_->lattice_exponent = coder.lattice_exponent();
    data_->mesh = CornerMesh(triangles, vertices);
    data_->P = Points::Zero(vertices, 3);
    data_->vertex_end.assign(index(vertices), kMissing);
    data_->triangle_end.assign(index(triangles), kMissing);
    data_->steps.resize(index(splits));
    data_->triangles_at.assign(index(splits) + 1, 0);
    read_coarsest(coder, vertices - splits);
    data_->level = splits;
    for (std::int64_t level = splits; level > 0; --level) read_split(coder, level);
    if (in_.left() > 0) in_.refuse("something follows the splits");
    if (std::count(data_->triangle_end.begin(), data_->triangle_end.end(), kMissing) > 0)
      in_.refuse("a triangle is missing");
    return std::move(data_);
  }

 private:
  static constexpr std::int32_t kMissing = -2;

  // The row behind the last one that a difference leads to.
  std::int32_t next_row(std::int32_t last, std::size_t rows) {
    const std::int64_t row = last + std::int64_t{1} + in_.below(2147483647);
    if (row >= static_cast<std::int64_t>(rows)) in_.refuse("a row is out of range");
    return static_cast<std::int32_t>(row);
  }

  void read_coarsest(const PositionCoder& coder, std::int64_t count) {
    Eigen::RowVector3d near = Eigen::RowVector3d::Zero();
    std::int32_t last = -1;
    for (std::int64_t i = 0; i < count; ++i) {
      last = next_row(last, data_->vertex_end.size());
      data_->vertex_end[index(last)] = ProgressiveMesh::Data::kNever;
      near = coder.read(in_, static_cast<PositionCoder::Mode>(in_.below(4)), near);
      data_->P.row(last) = near;
    }
    const std::int64_t triangles = in_.count(4);
    data_->triangles_at.back() = triangles;
    std::vector<std::int32_t> rows;
    last = -1;
    for (std::int64_t i = 0; i < triangles; ++i) {
      last = next_row(last, data_->triangle_end.size());
      std::array<std::int32_t, 3> ids{};
      for (std::int32_t& v : ids) {
        v = in_.below(data_->P.rows());
        if (data_->vertex_end[index(v)] == kMissing) in_.refuse("a vertex is missing");
      }
      if (ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0])
        in_.refuse("a triangle names a vertex twice");
      data_->triangle_end[index(last)] = ProgressiveMesh::Data::kNever;
      data_->mesh.set_triangle(last, ids[0], ids[1], ids[2]);
      rows.push_back(last);
    }
    if (!data_->mesh.connect(rows)) in_.refuse("the coarsest level is not a manifold");
  }

  // A triangle that is not there yet, by its difference to another one.
  std::int32_t new_triangle(std::int64_t near, std::int64_t level) {
    const std::int64_t row = near + in_.signed_number();
    if (row < 0 || row >= static_cast<std::int64_t>(data_->triangle_end.size()) ||
        data_->triangle_end[index(row)] != kMissing) {
      in_.refuse("a new triangle has no row of its own");
    }
    data_->triangle_end[index(row)] = static_cast<std::int32_t>(level - 1);
    return static_cast<std::int32_t>(row);
  }

  void read_split(const PositionCoder& coder, std::int64_t level) {
    const std::uint8_t flags = in_.byte();
    const int left_turn = flags & 3, right_turn = flags >> 2 & 3;
    const auto kept = static_cast<PositionCoder::Mode>(flags >> 4 & 3);
    const auto removed = static_cast<PositionCoder::Mode>(flags >> 6);
    const std::int32_t v = in_.below(data_->P.rows());
    if (data_->vertex_end[index(v)] == kMissing || data_->mesh.corner_at(v) < 0)
      in_.refuse("a vertex that is split is missing");
    const std::int64_t u = v + in_.signed_number();
    if (u < 0 || u >= data_->P.rows() || data_->vertex_end[index(u)] != kMissing)
      in_.refuse("a new vertex has no row of its own");
    const Ring ring(data_->mesh, v);
    std::int64_t near = ring.first_triangle();
    std::int32_t left = -1, right = -1, left_place = -1, right_place = -1;
    if (left_turn < 3) {
      near = left = new_triangle(near, level);
      left_place = in_.below(ring.size());
    }
    if (right_turn < 3) {
      right = new_triangle(near, level);
      right_place = in_.below(ring.size());
    }
    const bool fits = left_place != right_place && (ring.open() || (left >= 0 && right >= 0));
    if (!fits) in_.refuse("a split does not fit the neighbours of its vertex");

    ProgressiveStep& step = data_->steps[index(level - 1)];
    step.kept_after = data_->P.row(v);
    step.kept_before = coder.read(in_, kept, step.kept_after);
    step.removed = coder.read(in_, removed, step.kept_after);
    if (left >= 0) step.place.left = 3 * left + left_turn;
    if (right >= 0) step.place.right = 3 * right + right_turn;
    insert(step.place, static_cast<std::int32_t>(u), v, ring, left_place, right_place);
    data_->vertex_end[index(u)] = static_cast<std::int32_t>(level - 1);
    data_->triangles_at[index(level - 1)] =
        data_->triangles_at[index(level)] + (left >= 0 ? 1 : 0) + (right >= 0 ? 1 : 0);
    data_->refine();
  }

  // Fills the new triangles as a collapse would have left them.
  void insert(const CollapsePlace& place, std::int32_t u, std::int32_t v, const Ring& ring,
              std::int32_t left_place, std::int32_t right_place) {
    CornerMesh& mesh = data_->mesh;
    const auto fill = [&mesh](Corner at_u, std::int32_t first, std::int32_t second,
                              std::int32_t third) {
      std::array<std::int32_t, 3> ids{};
      ids[index(at_u % 3)] = first;
      ids[index(detail::next(at_u) % 3)] = second;
      ids[index(detail::previous(at_u) % 3)] = third;
      mesh.fill_triangle(at_u / 3, ids);
    };
    if (place.left >= 0) {
      fill(place.left, u, v, ring.neighbour(left_place));
      mesh.set_beyond(place.left, ring.across_before(left_place));
      mesh.set_beyond(detail::next(place.left), ring.across_behind(left_place));
    }
    if (place.right >= 0) {
      fill(place.right, u, ring.neighbour(right_place), v);
      mesh.set_beyond(place.right, ring.across_behind(right_place));
      mesh.set_beyond(detail::previous(place.right), ring.across_before(right_place));
    }
    if (place.left >= 0 && place.right >= 0) {
      mesh.set_beyond(detail::previous(place.left), detail::next(place.right));
      mesh.set_beyond(detail::next(place.right), detail::previous(place.left));
    }
  }

  ByteReader in_;
  std::unique_ptr<ProgressiveMesh::Data> data_;
};

}  // namespace

std::vector<std::byte> ProgressiveMesh::to_bytes() const {
  ProgressiveMesh finest(*this);
  finest.set_triangle_count(finest.finest());
  return Writer(*finest.data_).run(finest.data_->P);
}

ProgressiveMesh ProgressiveMesh::from_bytes(const std::byte* data, std::size_t size) {
  return ProgressiveMesh(Reader(data, size).run());
}

}  // namespace shape3d::mapping
