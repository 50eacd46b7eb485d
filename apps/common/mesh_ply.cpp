#include <optional>

#include "mesh_formats.hpp"
#include "text_scanner.hpp"

namespace shape3d::apps::formats {
namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::int8:
    case Scalar::uint8:
      return 1;
    case Scalar::int16:
    case Scalar::uint16:
      return 2;
    case Scalar::int32:
    case Scalar::uint32:
    case Scalar::float32:
      return 4;
    case Scalar::float64:
      return 8;
  }
  return 0;
}

std::optional<Scalar> scalar_named(std::string_view name) {
  static constexpr std::pair<std::string_view, Scalar> kNames[] = {
      {"char", Scalar::int8},      {"int8", Scalar::int8},       {"uchar", Scalar::uint8},
      {"uint8", Scalar::uint8},    {"short", Scalar::int16},     {"int16", Scalar::int16},
      {"ushort", Scalar::uint16},  {"uint16", Scalar::uint16},   {"int", Scalar::int32},
      {"int32", Scalar::int32},    {"uint", Scalar::uint32},     {"uint32", Scalar::uint32},
      {"float", Scalar::float32},  {"float32", Scalar::float32}, {"double", Scalar::float64},
      {"float64", Scalar::float64}};
  for (const auto& [text, type] : kNames) {
    if (text == name) return type;
  }
  return std::nullopt;
}

// Without decimals where it has none.
std::string plain(double number) {
  std::array<char, 400> text;
  const auto format =
      number == std::floor(number) ? std::chars_format::fixed : std::chars_format::general;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number, format).ptr};
}

struct Property {
  std::string name;
  bool is_list = false;
  Scalar count_type = Scalar::uint8;  // of a list
  Scalar type = Scalar::float32;
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;

  [[nodiscard]] int find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property) return static_cast<int>(i);
    }
    return -1;
  }
};

enum class Encoding { ascii, little, big };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
};

template <class T, bool kSwap>
T load(const char* at) {
  std::array<char, sizeof(T)> bytes;
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = at[kSwap ? sizeof(T) - 1 - i : i];
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <bool kSwap>
double load_scalar(const char* at, Scalar type) {
  switch (type) {
    case Scalar::int8:
      return load<std::int8_t, kSwap>(at);
    case Scalar::uint8:
      return load<std::uint8_t, kSwap>(at);
    case Scalar::int16:
      return load<std::int16_t, kSwap>(at);
    case Scalar::uint16:
      return load<std::uint16_t, kSwap>(at);
    case Scalar::int32:
      return load<std::int32_t, kSwap>(at);
    case Scalar::uint32:
      return load<std::uint32_t, kSwap>(at);
    case Scalar::float32:
      return load<float, kSwap>(at);
    case Scalar::float64:
      return load<double, kSwap>(at);
  }
  return 0.0;
}

constexpr bool host_is_little() {
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  return false;
#else
  return true;
#endif
}

// Values of the body one after another, from text or bytes; the same interface, so that the
// elements are parsed by one template.
class TextBody {
 public:
  TextBody(TextScanner& scanner) : scanner_(scanner) {}
  double next(const Property& property, Scalar type) {
    if (type == Scalar::float32 || type == Scalar::float64) return scanner_.number(property.name);
    return static_cast<double>(scanner_.integer(property.name));
  }
  void skip(const Property& property, Scalar) { scanner_.word(property.name); }
  [[noreturn]] void fail(const std::string& sentence) const { scanner_.fail(sentence); }
  // A value takes a digit and a separator at least.
  [[nodiscard]] std::size_t room_for(Scalar) const { return (scanner_.remaining() + 1) / 2; }

 private:
  TextScanner& scanner_;
};

template <bool kSwap>
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, std::size_t offset, const std::string& name)
      : bytes_(bytes), at_(offset), name_(name) {}
  double next(const Property& property, Scalar type) {
    const char* at = take(property, type);
    return load_scalar<kSwap>(at, type);
  }
  void skip(const Property& property, Scalar type) { take(property, type); }
  [[noreturn]] void fail(const std::string& sentence) const {
    throw FileError(name_, "byte " + std::to_string(at_) + ": " + sentence);
  }
  [[nodiscard]] std::size_t room_for(Scalar type) const {
    return (bytes_.size() - at_) / size_of(type);
  }
  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - at_; }

 private:
  const char* take(const Property& property, Scalar type) {
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size)
      fail("expected " + property.name + ", found the end of the file");
    const char* at = bytes_.data() + at_;
    at_ += size;
    return at;
  }

  std::string_view bytes_;
  std::size_t at_;
  const std::string& name_;
};

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), collector_(indices_) {}

  MeshFile parse() {
    TextScanner scanner(bytes_, name_, '\0');
    read_header(scanner);
    check_sizes(scanner);
    find_space(file_.mesh);
    file_.format = MeshFormat::ply;
    switch (header_.encoding) {
      case Encoding::ascii: {
        file_.encoding = "ascii";
        TextBody body(scanner);
        read_body(body);
        break;
      }
      case Encoding::little:
        file_.encoding = "binary little endian";
        read_binary<!host_is_little()>(scanner);
        break;
      case Encoding::big:
        file_.encoding = "binary big endian";
        read_binary<host_is_little()>(scanner);
        break;
    }
    collector_.report(file_);
    store(file_.mesh, positions_, indices_, name_);
    return std::move(file_);
  }

 private:
  void read_header(TextScanner& scanner) {
    if (bytes_.substr(0, 3) != "ply" || scanner.rest_of_line() != "ply") {
      throw FileError(name_, "line 1: expected 'ply'");
    }
    bool format_seen = false;
    while (true) {
      const std::string_view keyword = scanner.word("a header line or end_header");
      if (keyword == "end_header") {
        scanner.rest_of_line();
        break;
      }
      if (keyword == "comment" || keyword == "obj_info") {
        file_.mesh.comments.emplace_back(scanner.rest_of_line());
      } else if (keyword == "format") {
        read_format(scanner);
        format_seen = true;
      } else if (keyword == "element") {
        Element element;
        element.name = scanner.word("the name of an element");
        element.count = scanner.integer("the number of elements");
        if (element.count < 0)
          scanner.fail("element " + element.name + " has the count " +
                       std::to_string(element.count));
        header_.elements.push_back(std::move(element));
        scanner.rest_of_line();
      } else if (keyword == "property") {
        read_property(scanner);
      } else {
        scanner.fail("format, element, property, comment or end_header", keyword);
      }
    }
    if (!format_seen) throw FileError(name_, "the header has no format line");
  }

  void read_format(TextScanner& scanner) {
    const std::string_view encoding = scanner.word("the encoding");
    if (encoding == "ascii") {
      header_.encoding = Encoding::ascii;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = Encoding::little;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = Encoding::big;
    } else {
      scanner.fail("ascii, binary_little_endian or binary_big_endian", encoding);
    }
    scanner.rest_of_line();
  }

  void read_property(TextScanner& scanner) {
    if (header_.elements.empty()) scanner.fail("a property stands before the first element");
    const auto read_type = [&] {
      const std::string_view word = scanner.word("the type of a property");
      const std::optional<Scalar> type = scalar_named(word);
      if (!type) scanner.fail("a type (char, uchar, short … double)", word);
      return *type;
    };
    Property property;
    TextScanner ahead = scanner;
    if (ahead.word("the type of a property") == "list") {
      scanner = ahead;
      property.is_list = true;
      property.count_type = read_type();
      if (property.count_type == Scalar::float32 || property.count_type == Scalar::float64) {
        scanner.fail("the length of a list has to be an integer");
      }
    }
    property.type = read_type();
    property.name = scanner.word("the name of a property");
    header_.elements.back().properties.push_back(std::move(property));
    scanner.rest_of_line();
  }

  // Compares what the header announces with the bytes that follow.
  void check_sizes(const TextScanner& scanner) const {
    const std::size_t room = scanner.remaining();
    double least = 0.0;  // a double, so that no product overflows
    for (const Element& element : header_.elements) {
      double each = 0.0;
      for (const Property& property : element.properties) {
        each += header_.encoding == Encoding::ascii
                    ? 2.0
                    : static_cast<double>(
                          size_of(property.is_list ? property.count_type : property.type));
      }
      if (element.properties.empty() && element.count > 0) {
        throw FileError(name_, "element " + element.name + " has no properties");
      }
      if (element.count > kMaxCount) {
        throw FileError(name_, "the header announces " + std::to_string(element.count) +
                                   " elements " + element.name + ", expected at most 2147483647");
      }
      least += each * static_cast<double>(element.count);
    }
    if (least > static_cast<double>(room) + 1.0) {  // the last line may lack its end
      throw FileError(name_, "the header announces " + plain(least) +
                                 " bytes or more of data, but " + std::to_string(room) +
                                 " follow it");
    }
  }

  template <bool kSwap>
  void read_binary(const TextScanner& scanner) {
    BinaryBody<kSwap> body(bytes_, scanner.offset(), name_);
    read_body(body);
    if (body.remaining() > 0) {
      file_.warnings.push_back(std::to_string(body.remaining()) +
                               " bytes after the last element were not read");
    }
  }

  template <class Body>
  void read_body(Body& body) {
    bool vertices_seen = false;
    for (const Element& element : header_.elements) {
      if (element.name == "vertex") {
        vertices_seen = true;
        read_vertices(element, body);
      } else if (element.name == "face") {
        if (!vertices_seen) throw FileError(name_, "element face stands before element vertex");
        read_faces(element, body);
      } else if (element.name == "tristrips") {
        throw FileError(name_, "triangle strips are not supported, expected element face");
      } else {
        for (std::int64_t i = 0; i < element.count; ++i) {
          for (const Property& property : element.properties) skip(property, body);
        }
      }
    }
    if (!vertices_seen) throw FileError(name_, "the header has no element vertex");
  }

  template <class Body>
  std::int64_t list_length(const Property& property, Body& body) {
    const double length = body.next(property, property.count_type);
    if (length < 0 || length > static_cast<double>(body.room_for(property.type))) {
      body.fail("a list " + property.name + " of " + plain(length) +
                " values does not fit the file");
    }
    return static_cast<std::int64_t>(length);
  }

  template <class Body>
  void skip(const Property& property, Body& body) {
    const std::int64_t length = property.is_list ? list_length(property, body) : 1;
    for (std::int64_t i = 0; i < length; ++i) body.skip(property, property.type);
  }

  template <class Body>
  void read_vertices(const Element& element, Body& body) {
    std::vector<int> coordinate(element.properties.size(), -1);
    for (int c = 0; c < 3; ++c) {
      const int index =
          element.find(std::string_view("xyz").substr(static_cast<std::size_t>(c), 1));
      if (index < 0)
        throw FileError(name_, std::string("element vertex has no property ") + "xyz"[c]);
      if (element.properties[static_cast<std::size_t>(index)].is_list) {
        throw FileError(name_, std::string("property ") + "xyz"[c] +
                                   " of element vertex is a list, expected a number");
      }
      coordinate[static_cast<std::size_t>(index)] = c;
    }
    positions_.resize(static_cast<std::size_t>(3 * element.count));
    for (std::int64_t v = 0; v < element.count; ++v) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (coordinate[i] < 0) {
          skip(property, body);
          continue;
        }
        const double value = body.next(property, property.type);
        if (!std::isfinite(value)) {
          body.fail("expected a finite coordinate " + property.name + " of vertex " +
                    std::to_string(v));
        }
        positions_[static_cast<std::size_t>(3 * v + coordinate[i])] = value;
      }
    }
  }

  template <class Body>
  void read_faces(const Element& element, Body& body) {
    int ids = element.find("vertex_indices");
    if (ids < 0) ids = element.find("vertex_index");
    if (ids < 0 || !element.properties[static_cast<std::size_t>(ids)].is_list) {
      throw FileError(name_, "element face has no list property vertex_indices");
    }
    const auto vertices = static_cast<std::int64_t>(positions_.size() / 3);
    indices_.reserve(static_cast<std::size_t>(3 * element.count));
    std::vector<std::int64_t> polygon;
    for (std::int64_t f = 0; f < element.count; ++f) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const Property& property = element.properties[i];
        if (static_cast<int>(i) != ids) {
          skip(property, body);
          continue;
        }
        const std::int64_t corners = list_length(property, body);
        polygon.clear();
        for (std::int64_t c = 0; c < corners; ++c) {
          const double id = body.next(property, property.type);
          if (!(id >= 0.0 && id < static_cast<double>(vertices)) || id != std::floor(id)) {
            body.fail("face " + std::to_string(f) + ": expected a vertex index from 0 to " +
                      std::to_string(vertices - 1) + ", found " + plain(id));
          }
          polygon.push_back(static_cast<std::int64_t>(id));
        }
        collector_.add(polygon.data(), polygon.size());
      }
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  Header header_;
  MeshFile file_;
  std::vector<double> positions_;
  std::vector<std::int32_t> indices_;
  FaceCollector collector_;
};

template <class T>
void write_reversed(OutputFile& file, T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  std::reverse(bytes.begin(), bytes.end());
  file.write(bytes.data(), bytes.size());
}

template <bool kSwap>
void write_binary_body(OutputFile& file, const MeshView& mesh) {
  const auto put = [&file](auto value) {
    if constexpr (kSwap) {
      write_reversed(file, value);
    } else {
      file.write_binary(value);
    }
  };
  if constexpr (kSwap) {
    for (std::int64_t i = 0; i < 3 * mesh.vertex_count; ++i) put(mesh.positions[i]);
  } else {
    file.write(mesh.positions, static_cast<std::size_t>(3 * mesh.vertex_count) * sizeof(double));
  }
  for_each_triangle(mesh, [&](const std::array<std::int64_t, 3>& ids) {
    put(std::uint8_t{3});
    for (const std::int64_t id : ids) put(static_cast<std::uint32_t>(id));
  });
}

void write_ascii_body(OutputFile& file, const MeshView& mesh) {
  for (std::int64_t v = 0; v < mesh.vertex_count; ++v) {
    for (int c = 0; c < 3; ++c) {
      file.write_number(mesh.positions[3 * v + c]);
      file.write_char(c < 2 ? ' ' : '\n');
    }
  }
  for_each_triangle(mesh, [&](const std::array<std::int64_t, 3>& ids) {
    file.write_char('3');
    for (const std::int64_t id : ids) {
      file.write_char(' ');
      file.write_number(id);
    }
    file.write_char('\n');
  });
}

}  // namespace

MeshFile parse_ply(std::string_view bytes, const std::string& name) {
  return PlyParser(bytes, name).parse();
}

void write_ply(OutputFile& file, const MeshView& mesh, MeshEncoding encoding) {
  constexpr std::int64_t kMaxIds = std::int64_t{1} << 32;
  if (mesh.vertex_count > kMaxIds) {
    throw FileError(file.path(), "PLY numbers at most 4294967296 vertices, the mesh has " +
                                     std::to_string(mesh.vertex_count) +
                                     "; OBJ, OFF and VTP hold more");
  }
  const bool big = encoding == MeshEncoding::binary_big_endian ||
                   (encoding == MeshEncoding::binary && !host_is_little());
  file.write("ply\nformat ");
  file.write(encoding == MeshEncoding::ascii ? "ascii"
             : big                           ? "binary_big_endian"
                                             : "binary_little_endian");
  file.write(" 1.0\n");
  for (const std::string& line : comment_lines(mesh)) file.write("comment " + line + "\n");
  file.write("element vertex " + std::to_string(mesh.vertex_count) +
             "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
             std::to_string(mesh.triangle_count) + "\nproperty list uchar ");
  file.write(mesh.vertex_count > kMaxCount ? "uint" : "int");
  file.write(" vertex_indices\nend_header\n");
  if (encoding == MeshEncoding::ascii) {
    write_ascii_body(file, mesh);
  } else if (big == host_is_little()) {
    write_binary_body<true>(file, mesh);
  } else {
    write_binary_body<false>(file, mesh);
  }
}

}  // namespace shape3d::apps::formats
