#include "dicom_elements.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <optional>

#include "text.hpp"

namespace shape3d::apps {
namespace {

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000;
constexpr std::uint32_t kItemEnd = 0xfffee00d;
constexpr std::uint32_t kSequenceEnd = 0xfffee0dd;
constexpr std::uint32_t kTransferSyntax = 0x00020010;
constexpr std::uint32_t kPixelGroup = 0x7fe0;
constexpr std::uint32_t kFunctionalGroup = 0x5200;
// Real files nest less than ten deep.
constexpr int kDeepest = 32;

constexpr std::string_view kImplicitLittle = "1.2.840.10008.1.2";
constexpr std::string_view kExplicitBig = "1.2.840.10008.1.2.2";
constexpr std::string_view kDeflated = "1.2.840.10008.1.2.1.99";

/// A value representation.
struct Representation {
  std::string_view name;
  unsigned unit;   ///< Length is a multiple of it.
  bool long_form;  ///< Two reserved bytes and a 32-bit length.
};

constexpr std::array<Representation, 34> kRepresentations{{
    {"AE", 1, false}, {"AS", 1, false}, {"AT", 4, false}, {"CS", 1, false}, {"DA", 1, false},
    {"DS", 1, false}, {"DT", 1, false}, {"FD", 8, false}, {"FL", 4, false}, {"IS", 1, false},
    {"LO", 1, false}, {"LT", 1, false}, {"OB", 1, true},  {"OD", 8, true},  {"OF", 4, true},
    {"OL", 4, true},  {"OV", 8, true},  {"OW", 2, true},  {"PN", 1, false}, {"SH", 1, false},
    {"SL", 4, false}, {"SQ", 1, true},  {"SS", 2, false}, {"ST", 1, false}, {"SV", 8, true},
    {"TM", 1, false}, {"UC", 1, true},  {"UI", 1, false}, {"UL", 4, false}, {"UN", 1, true},
    {"UR", 1, true},  {"US", 2, false}, {"UT", 1, true},  {"UV", 8, true},
}};

const Representation* find_representation(std::string_view name) {
  const auto* found = std::find_if(kRepresentations.begin(), kRepresentations.end(),
                                   [&](const Representation& r) { return r.name == name; });
  return found == kRepresentations.end() ? nullptr : found;
}

/// How data elements are written.
struct Syntax {
  bool is_explicit = true;
  bool big_endian = false;
};

/// Tag, representation and length of an element.
struct Element {
  std::uint32_t tag = 0;
  const Representation* representation = nullptr;  ///< Null where it is implicit and for items.
  std::uint32_t length = 0;
  std::size_t start = 0;  ///< Of the tag.
};

// Groups 0000 to 0003 are for messages and the head of the file, odd ones below 0009 and ffff for
// nothing.
bool may_hold(std::uint32_t group) {
  return group == 4 || group == 6 || (group >= 8 && group != 0xffff);
}

class Walk {
 public:
  Walk(std::string_view bytes, std::optional<bool> (*is_sequence)(std::uint32_t tag))
      : bytes_(bytes), is_sequence_(is_sequence) {}

  std::string run() {
    Syntax syntax;
    std::string uid;
    if (bytes_.size() >= 132 && bytes_.substr(128, 4) == "DICM") {
      at_ = 132;
      if (!meta_group(uid)) return problem_;
    }
    if (uid == kDeflated) {
      return "is a deflated data set (transfer syntax " + uid +
             "); expected one that is not deflated";
    }
    syntax.big_endian = uid == kExplicitBig;
    // Without a transfer syntax the first element tells.
    syntax.is_explicit =
        uid.empty() ? left() >= 6 && find_representation(bytes_.substr(at_ + 4, 2)) != nullptr
                    : uid != kImplicitLittle;
    elements(syntax, bytes_.size(), false, 0);
    return problem_;
  }

 private:
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }

  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size, bool big_endian) const {
    std::uint32_t value = 0;
    for (std::size_t n = 0; n < size; ++n) {
      value = value << 8 | static_cast<unsigned char>(bytes_[at + (big_endian ? n : size - 1 - n)]);
    }
    return value;
  }

  bool fail(const Element& element, const std::string& what) {
    std::array<char, 80> place{};
    std::snprintf(place.data(), place.size(), "its data element (%04x,%04x) at byte %zu ",
                  element.tag >> 16, element.tag & 0xffffU, element.start);
    problem_ = place.data() + what;
    return false;
  }

  // False where the bytes end or the element makes no sense; at_ is then behind tag and length.
  bool next(const Syntax& syntax, std::size_t end, Element& element) {
    element = Element();
    element.start = at_;
    if (end - at_ < 8) return fail(element, "is cut off");
    const bool big = syntax.big_endian;
    element.tag = number(at_, 2, big) << 16 | number(at_ + 2, 2, big);
    at_ += 4;
    if (element.tag >> 16 == kItem >> 16 || !syntax.is_explicit) {
      element.length = number(at_, 4, big);
      at_ += 4;
      return true;
    }
    const std::string_view name = bytes_.substr(at_, 2);
    element.representation = find_representation(name);
    if (element.representation == nullptr) {
      return fail(element, "has the unknown value representation " + in_quotes(name));
    }
    if (!element.representation->long_form) {
      element.length = number(at_ + 2, 2, big);
      at_ += 4;
      return true;
    }
    if (end - at_ < 8) return fail(element, "is cut off");
    element.length = number(at_ + 4, 4, big);
    at_ += 8;
    return true;
  }

  // The group 0002, explicit and little-endian whatever follows.
  bool meta_group(std::string& uid) {
    while (left() >= 4 && number(at_, 2, false) == 2) {
      Element element;
      if (!next({}, bytes_.size(), element) || !value(element, bytes_.size())) return false;
      if (element.tag < 0x00020000) return fail(element, "is of a group that files do not have");
      if (element.tag != kTransferSyntax) continue;
      if (element.representation->name != "UI" || !uid.empty()) {
        return fail(element, "is no transfer syntax");
      }
      uid = trim(bytes_.substr(at_ - element.length, element.length));
    }
    return true;
  }

  // Steps over a value of defined length.
  bool value(const Element& element, std::size_t end) {
    // Element 0 of a group is its length.
    const bool group_length = (element.tag & 0xffffU) == 0 && element.tag != kItem;
    if (group_length && (element.length != 4 || (element.representation != nullptr &&
                                                 element.representation->name != "UL"))) {
      return fail(element, "is no group length of type UL");
    }
    if (element.length == kUndefined) return fail(element, "has no length");
    if (element.length > end - at_) {
      return fail(element, "is cut off: it has " + std::to_string(element.length) + " bytes, " +
                               std::to_string(end - at_) + " are left");
    }
    if (element.representation != nullptr && element.length % element.representation->unit != 0) {
      return fail(element, "has " + std::to_string(element.length) +
                               " bytes; expected a multiple of " +
                               std::to_string(element.representation->unit));
    }
    at_ += element.length;
    return true;
  }

  // Data elements up to `end`, or in an item of no length up to its end tag.
  bool elements(const Syntax& syntax, std::size_t end, bool until_tag, int depth) {
    while (at_ < end) {
      Element element;
      if (!next(syntax, end, element)) return false;
      if (until_tag && element.tag == kItemEnd) return true;
      if (depth == 0 && element.tag >> 16 == kPixelGroup && (element.tag & 0xffffU) != 0) {
        // Parsers read on behind pixel data, so that what is there must be data elements, too, or
        // filling. Whether the pixels are all there is told by their number.
        if (element.length == kUndefined) {
          if (!fragments(syntax, element)) return false;
        } else if (element.length > end - at_) {
          return true;
        } else {
          at_ += element.length;
        }
        if (bytes_.find_first_not_of('\0', at_) == std::string_view::npos) return true;
        continue;
      }
      if (element.tag >> 16 == kItem >> 16) return fail(element, "is an item outside a sequence");
      if (!may_hold(element.tag >> 16))
        return fail(element, "is of a group that data sets do not have");
      if (!content(syntax, element, end, depth)) return false;
    }
    if (until_tag) {
      Element element;
      element.start = at_;
      return fail(element, "is missing: an item has no end");
    }
    return true;
  }

  bool content(const Syntax& syntax, const Element& element, std::size_t end, int depth) {
    const std::string_view name =
        element.representation == nullptr ? "" : element.representation->name;
    const bool undefined = element.length == kUndefined;
    // What is implicit and unknown is a sequence when it has no length or begins with an item.
    const bool begins_with_item =
        !undefined && element.length >= 8 && end - at_ >= 8 &&
        (number(at_, 2, syntax.big_endian) << 16 | number(at_ + 2, 2, syntax.big_endian)) == kItem;
    const std::optional<bool> known = is_sequence_(element.tag);
    const bool sequence = name == "SQ" || (undefined && (name.empty() || name == "UN")) ||
                          (name.empty() && known.value_or(begins_with_item));
    // Parsers look into functional groups without looking what they are.
    const bool unknown_is_well = name == "UN" && element.tag >> 16 != kFunctionalGroup;
    if (known && *known != sequence && !unknown_is_well) {
      return fail(element, *known ? "is no sequence" : "is a sequence");
    }
    if (!sequence) return value(element, end);
    if (depth >= kDeepest) return fail(element, "is nested more than 32 deep");
    // Sequences of unknown representation are written implicitly.
    Syntax inner = syntax;
    if (name == "UN") inner = {false, false};
    if (undefined) return items(inner, end, true, depth);
    if (element.length > end - at_) return value(element, end);
    return items(inner, at_ + element.length, false, depth);
  }

  // The items of compressed pixel data.
  bool fragments(const Syntax& syntax, const Element& pixels) {
    while (at_ < bytes_.size()) {
      Element item;
      if (!next(syntax, bytes_.size(), item)) return fail(pixels, "is cut off");
      if (item.tag == kSequenceEnd) return true;
      if (item.tag != kItem || item.length > left()) {
        return fail(pixels, "is cut off or damaged at byte " + std::to_string(item.start));
      }
      at_ += item.length;
    }
    return fail(pixels, "is cut off: its compressed pixel data have no end");
  }

  bool items(const Syntax& syntax, std::size_t end, bool until_tag, int depth) {
    while (at_ < end) {
      Element item;
      if (!next(syntax, end, item)) return false;
      if (until_tag && item.tag == kSequenceEnd) return true;
      if (item.tag != kItem) return fail(item, "stands where an item of a sequence is expected");
      if (item.length == kUndefined) {
        if (!elements(syntax, end, true, depth + 1)) return false;
      } else if (item.length > end - at_) {
        return value(item, end);
      } else if (!elements(syntax, at_ + item.length, false, depth + 1)) {
        return false;
      }
    }
    if (until_tag) {
      Element element;
      element.start = at_;
      return fail(element, "is missing: a sequence has no end");
    }
    return true;
  }

  std::string_view bytes_;
  std::optional<bool> (*is_sequence_)(std::uint32_t tag);
  std::size_t at_ = 0;
  std::string problem_;
};

}  // namespace

std::string check_dicom_elements(std::string_view bytes,
                                 std::optional<bool> (*is_sequence)(std::uint32_t tag)) {
  return Walk(bytes, is_sequence).run();
}

}  // namespace shape3d::apps
