#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace shape3d::apps {

/// Numbers distinct positions 0, 1, 2 … in the order of first occurrence; equal means equal
/// coordinates (−0 and 0 are equal). Open addressing: amortised O(1) a look-up.
template <class Real>
class PositionTable {
 public:
  /// @param positions  Receives x y z of each new position; not to be changed by others meanwhile.
  explicit PositionTable(std::vector<Real>& positions, std::size_t expected = 0)
      : positions_(positions) {
    std::size_t size = 1024;
    while (size < 2 * expected) size *= 2;
    slots_.assign(size, kEmpty);
  }

  std::int64_t id_of(std::array<Real, 3> p) {
    for (Real& c : p) c += Real(0);  // −0 becomes 0
    for (std::size_t at = hash(p) & (slots_.size() - 1);; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at] == kEmpty) {
        const auto id = static_cast<std::uint32_t>(count_++);
        slots_[at] = id;
        positions_.insert(positions_.end(), p.begin(), p.end());
        if (2 * count_ > slots_.size()) grow();
        return id;
      }
      const Real* q = positions_.data() + 3 * std::size_t{slots_[at]};
      if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) return slots_[at];
    }
  }

  [[nodiscard]] std::int64_t size() const { return static_cast<std::int64_t>(count_); }

 private:
  static constexpr std::uint32_t kEmpty = 0xffffffff;

  static std::size_t hash(const std::array<Real, 3>& p) {
    std::uint64_t h = 0;
    for (const Real c : p) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &c, sizeof c);
      h = (h ^ bits) * 0x9e3779b97f4a7c15ULL;
      h ^= h >> 32;
    }
    return static_cast<std::size_t>(h);
  }

  void grow() {
    std::vector<std::uint32_t> old(2 * slots_.size(), kEmpty);
    old.swap(slots_);
    for (std::size_t id = 0; id < count_; ++id) {
      const Real* q = positions_.data() + 3 * id;
      std::size_t at = hash({q[0], q[1], q[2]}) & (slots_.size() - 1);
      while (slots_[at] != kEmpty) at = (at + 1) & (slots_.size() - 1);
      slots_[at] = static_cast<std::uint32_t>(id);
    }
  }

  std::vector<Real>& positions_;
  std::vector<std::uint32_t> slots_;
  std::size_t count_ = 0;
};

}  // namespace shape3d::apps
