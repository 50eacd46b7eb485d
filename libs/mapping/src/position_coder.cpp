#include "position_coder.hpp"

#include <cmath>
#include <cstring>

namespace shape3d::mapping::detail {
namespace {

constexpr double kLargest = 4503599627370496.0;  // 2⁵²: whole numbers that double tells apart
constexpr int kDecimals = 15;

std::uint64_t bits(double x) {
  std::uint64_t result = 0;
  std::memcpy(&result, &x, sizeof x);
  return result;
}

double from_bits(std::uint64_t word) {
  double result = 0.0;
  std::memcpy(&result, &word, sizeof word);
  return result;
}

std::uint32_t float_bits(double x) {
  const auto single = static_cast<float>(x);
  std::uint32_t result = 0;
  std::memcpy(&result, &single, sizeof single);
  return result;
}

double from_float_bits(std::uint32_t word) {
  float single = 0.0F;
  std::memcpy(&single, &word, sizeof single);
  return static_cast<double>(single);
}

bool same(const Eigen::RowVector3d& a, const Eigen::RowVector3d& b) {
  return bits(a[0]) == bits(b[0]) && bits(a[1]) == bits(b[1]) && bits(a[2]) == bits(b[2]);
}

}  // namespace

void PositionCoder::Grid::set(Kind new_kind, int new_exponent) {
  kind = new_kind;
  exponent = new_exponent;
  factor = kind == Kind::decimal ? std::pow(10.0, exponent) : std::ldexp(1.0, exponent);
}

double PositionCoder::Grid::nearest(double x) const {
  const double number =
      std::nearbyint(kind == Kind::decimal ? x * factor : std::ldexp(x, -exponent));
  // Without the sign of −0, which whole numbers do not have. 0 for a neighbour is as good as any.
  return std::abs(number) <= kLargest ? number + 0.0 : 0.0;
}

double PositionCoder::Grid::value(double number) const {
  return kind == Kind::decimal ? number / factor : std::ldexp(number, exponent);
}

bool PositionCoder::Grid::holds(double x) const {
  if (kind == Kind::single) return bits(static_cast<double>(static_cast<float>(x))) == bits(x);
  return kind != Kind::none && bits(value(nearest(x))) == bits(x);
}

PositionCoder::PositionCoder(const Points& V, int lattice_exponent) {
  lattice_.set(Grid::Kind::binary, lattice_exponent);
  const auto all = [&V](const Grid& grid) {
    for (Eigen::Index i = 0; i < V.size(); ++i)
      if (!grid.holds(V.data()[i])) return false;
    return true;
  };
  for (int digits = 0; digits <= kDecimals; ++digits) {
    input_.set(Grid::Kind::decimal, digits);
    if (all(input_)) return;
  }
  input_.set(Grid::Kind::single, 0);
  if (all(input_)) return;
  // The power of two is that of the lowest bit of any coordinate.
  int lowest = 1 << 20;
  for (Eigen::Index i = 0; i < V.size(); ++i) {
    const double x = V.data()[i];
    if (x == 0.0) continue;
    int exponent = 0;
    const auto mantissa =
        static_cast<std::int64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), 53));
    int zeros = 0;
    while (((mantissa >> zeros) & 1) == 0) ++zeros;
    lowest = std::min(lowest, exponent - 53 + zeros);
  }
  input_.set(Grid::Kind::binary, lowest);
  if (lowest == 1 << 20 || !all(input_)) input_.set(Grid::Kind::none, 0);
}

PositionCoder::PositionCoder(ByteReader& header) {
  const std::int64_t lattice = header.signed_number();
  const std::uint8_t kind = header.byte();
  const std::int64_t input = header.signed_number();
  const bool fits = std::abs(lattice) < 1200 && std::abs(input) < 1200 && kind <= 3 &&
                    (kind != 2 || (input >= 0 && input <= kDecimals));
  if (!fits) header.refuse("the form of its coordinates is unknown");
  lattice_.set(Grid::Kind::binary, static_cast<int>(lattice));
  input_.set(static_cast<Grid::Kind>(kind), static_cast<int>(input));
}

void PositionCoder::write_header(ByteWriter& out) const {
  out.signed_number(lattice_.exponent);
  out.byte(static_cast<std::uint8_t>(input_.kind));
  out.signed_number(input_.exponent);
}

PositionCoder::Mode PositionCoder::mode_of(const Eigen::RowVector3d& p,
                                           const Eigen::RowVector3d& near) const {
  if (same(p, near)) return Mode::same;
  Mode best = Mode::raw;
  int least = 24;
  for (const Mode mode : {Mode::lattice, Mode::input}) {
    const Grid& grid = grid_of(mode);
    if (!grid.holds(p[0]) || !grid.holds(p[1]) || !grid.holds(p[2])) continue;
    int size = 0;
    for (int i = 0; i < 3; ++i) {
      size += grid.kind == Grid::Kind::single
                  ? 4
                  : ByteWriter::size_of(ByteWriter::zigzag(
                        static_cast<std::int64_t>(grid.nearest(p[i]) - grid.nearest(near[i]))));
    }
    if (size < least) {
      least = size;
      best = mode;
    }
  }
  return best;
}

void PositionCoder::write(ByteWriter& out, Mode mode, const Eigen::RowVector3d& p,
                          const Eigen::RowVector3d& near) const {
  if (mode == Mode::same) return;
  for (int i = 0; i < 3; ++i) {
    const Grid& grid = grid_of(mode);
    if (mode == Mode::raw) {
      out.word(bits(p[i]));
    } else if (grid.kind == Grid::Kind::single) {
      out.half_word(float_bits(p[i]));
    } else {
      out.signed_number(static_cast<std::int64_t>(grid.nearest(p[i]) - grid.nearest(near[i])));
    }
  }
}

Eigen::RowVector3d PositionCoder::read(ByteReader& in, Mode mode,
                                       const Eigen::RowVector3d& near) const {
  Eigen::RowVector3d p = near;
  if (mode == Mode::same) return p;
  for (int i = 0; i < 3; ++i) {
    const Grid& grid = grid_of(mode);
    if (mode == Mode::raw) {
      p[i] = from_bits(in.word());
    } else if (grid.kind == Grid::Kind::single) {
      p[i] = from_float_bits(in.half_word());
    } else {
      p[i] = grid.value(grid.nearest(near[i]) + static_cast<double>(in.signed_number()));
    }
    if (!std::isfinite(p[i])) in.refuse("a coordinate is not finite");
  }
  return p;
}

}  // namespace shape3d::mapping::detail
