#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "byte_stream.hpp"
#include "shape3d/mapping/mesh.hpp"

namespace shape3d::mapping::detail {

/// Writes positions as differences to a position that the reader knows, exactly.
///
/// Where all coordinates of a mesh are decimals of k digits behind the point, or multiples of a
/// power of two, they are written as whole numbers; so are positions on the lattice of collapses.
class PositionCoder {
 public:
  /// How a position is written; two bits.
  enum class Mode : std::uint8_t { same = 0, lattice = 1, input = 2, raw = 3 };

  /// Finds what the coordinates of a mesh have in common.
  PositionCoder(const Points& V, int lattice_exponent);
  explicit PositionCoder(ByteReader& header);
  void write_header(ByteWriter& out) const;
  [[nodiscard]] int lattice_exponent() const { return lattice_.exponent; }

  /// The mode of the fewest bytes.
  [[nodiscard]] Mode mode_of(const Eigen::RowVector3d& p, const Eigen::RowVector3d& near) const;
  void write(ByteWriter& out, Mode mode, const Eigen::RowVector3d& p,
             const Eigen::RowVector3d& near) const;
  [[nodiscard]] Eigen::RowVector3d read(ByteReader& in, Mode mode,
                                        const Eigen::RowVector3d& near) const;

 private:
  /// Coordinates are whole numbers times 2 to the power of e, or over 10 to the power of e.
  struct Grid {
    enum class Kind : std::uint8_t { none = 0, binary = 1, decimal = 2, single = 3 };
    Kind kind = Kind::none;  ///< single: floats, written as such.
    int exponent = 0;
    double factor = 1.0;  ///< 2^e, 10^e.

    void set(Kind new_kind, int new_exponent);
    [[nodiscard]] double nearest(double x) const;  ///< Whole number of the nearest grid point.
    [[nodiscard]] double value(double number) const;
    [[nodiscard]] bool holds(double x) const;  ///< To the bit.
  };

  [[nodiscard]] const Grid& grid_of(Mode mode) const {
    return mode == Mode::input ? input_ : lattice_;
  }

  Grid lattice_, input_;
};

}  // namespace shape3d::mapping::detail
