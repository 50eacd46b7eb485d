#pragma once

#include <cstdint>
#include <vector>

#include "advance_rows.hpp"
#include "padded_field.hpp"

namespace shape3d::levelset::detail {

/// ψ in two buffers and the tiles that are computed.
///
/// A step reads one buffer and writes the other, tile by tile. Tiles that are not active hold the
/// same values in both. In an active tile only the rows are computed that hold a node nearer than
/// the band's limit, or lie beside one that does; the others are copied. A tile is active when the
/// front is in it or in one that touches it, and has moved, in one of these, since the redistancing
/// before the last.
class NarrowBand {
 public:
  /// @param psi     Any function of the right signs. The first redistancing is done here.
  /// @param factor  May be empty: 1.
  NarrowBand(const Lattice& lattice, const Field& psi, const Field& advance, const Field& factor,
             float limit, int threads);

  /// Largest |advance| in the active tiles.
  [[nodiscard]] float max_speed() const;
  /// One step in all active tiles. Returns the number of nodes that changed sides.
  std::int64_t advance(const Step& step);

  /// What redistance() found of the front.
  struct Motion {
    double mean = 0.0;      ///< mm, over the nodes beside the front.
    double greatest = 0.0;  ///< mm, of the tile where it moved most.
    std::int64_t nodes = 0;
  };
  /// Makes ψ a distance again and chooses the active tiles: a tile is at rest when the mean
  /// displacement of the front in it since the last call is at most `rest` mm.
  Motion redistance(double rest);

  [[nodiscard]] std::int64_t active_tiles() const {
    return static_cast<std::int64_t>(active_.size());
  }
  [[nodiscard]] std::int64_t inside() const;
  /// ψ without ghosts.
  [[nodiscard]] Field copy() const;
  /// The same; the buffers are given up.
  [[nodiscard]] Field take();

 private:
  template <class Body>
  void for_active(const Body& body);
  void spread();
  void settle(const std::vector<char>& was, const std::vector<char>& now);

  const Lattice& lattice_;
  const Field &speed_, &factor_;
  Field current_, next_;
  float limit_, slope_;
  int threads_, redistancings_ = 0;
  std::vector<std::int64_t> active_;
  std::vector<char> is_active_, calm_;
  // By tile:
  std::vector<RowMask> near_, next_near_;  // rows with a node nearer than the limit
  std::vector<float> max_speed_;
  std::vector<int> inside_, crossed_, beside_;
  std::vector<double> volume_, volume_before_, anchor_;
};

}  // namespace shape3d::levelset::detail
