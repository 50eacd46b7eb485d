#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "advance_rows.hpp"
#include "padded_field.hpp"

namespace shape3d::levelset::detail {

/// ψ in two buffers and the tiles that are computed.
///
/// A step reads one buffer and writes the other, tile by tile. A tile is active when the front is
/// in it or in one that touches it, and has moved there between the last two redistancings. In an
/// active tile only the rows are computed that the front may reach before the next redistancing;
/// all others hold the same values in both buffers.
class NarrowBand {
 public:
  /// @param psi     Any function of the right signs. The first redistancing is done here, after it
  ///                was given up.
  /// @param factor  May be empty: 1.
  /// @param limit   |ψ| is cut at this, mm; at least the largest spacing.
  /// @param reach   The front moves by no more than this between two redistancings, mm; up to six
  ///                of the smallest spacings.
  NarrowBand(const Lattice& lattice, Field psi, const Field& advance, const Field& factor,
             float limit, double reach, int threads);

  /// Largest |advance| in the active tiles.
  [[nodiscard]] float max_speed() const { return max_speed_; }
  /// One step in all active tiles. Returns the number of nodes that changed sides.
  std::int64_t advance(const Step& step);

  /// What redistance() found of the front.
  struct Motion {
    double mean = 0.0;      ///< mm, over the nodes near the front.
    double greatest = 0.0;  ///< mm, of the tile where it moved most.
    std::int64_t nodes = 0;
  };
  /// Makes ψ a distance again and chooses the active tiles: a tile is at rest when the mean
  /// displacement of the front in it since the last call is at most `rest` mm.
  Motion redistance(double rest);

  [[nodiscard]] std::int64_t active_tiles() const {
    return static_cast<std::int64_t>(active_.size());
  }
  /// Nodes in the rows that a step computes.
  [[nodiscard]] std::int64_t computed_nodes() const { return computed_nodes_; }
  [[nodiscard]] std::int64_t inside() const { return inside_; }
  /// ψ without ghosts; away from the front only its sign is of use.
  [[nodiscard]] Field copy() const;
  /// ψ without ghosts, ±limit away from the front. The buffers are given up.
  [[nodiscard]] Field take();

 private:
  static constexpr int kMostPasses = 8;
  /// Rows of a tile within 1, 2, … steps of those where the front moves; the last are those that
  /// are computed.
  using Reaches = std::array<RowMask, kMostPasses>;
  struct Tally {
    Beside beside;
    Measures now;
    double volume_before = 0.0;  // one redistancing ago
    double sum = 0.0;            // of the volumes of this window
    double mean = 0.0;           // volume of the last window
    int calmed = 0;              // how many times
    double path = 0.0;           // sum of the changes of volume in this window
    double window_start = 0.0;   // volume when it began
    bool calm = false;
    RowMask moving = kAllRows;  // rows where the front moves
    std::array<float, 64> row_volume{};
  };

  template <class Body>
  void for_active(const Body& body);
  [[nodiscard]] Reaches reaches(std::int64_t t, bool moving) const;
  void spread(Far far, double rest);
  void measure(std::int64_t t, const TileRows& rows, double rest);
  void activate();
  [[nodiscard]] bool is_moving(Tally& tally, double rest, bool window_end, Motion& motion) const;

  const Lattice& lattice_;
  const Field &speed_, &factor_;
  Field current_, next_;
  float limit_, width_;  // half the width of the ramp that volumes are measured with
  int steps_[3];         // nodes along each axis that the front may go, and one
  int threads_, redistancings_ = 0;
  double window_rest_ = 0.0;  // mm that a tile may move in a window and be at rest
  float max_speed_ = 0.0F;
  std::int64_t inside_ = 0, computed_nodes_ = 0;
  std::vector<std::int64_t> active_;
  // By tile:
  std::vector<char> is_active_, is_moving_;
  std::vector<Reaches> rows_;
  std::vector<RowMask> near_;  // rows that the front may reach, moving or not
  std::vector<float> tile_speed_;
  std::vector<Tally> tallies_;
  std::vector<Change> changes_;
};

}  // namespace shape3d::levelset::detail
