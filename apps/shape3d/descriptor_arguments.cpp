#include "descriptor_arguments.hpp"

#include <set>
#include <stdexcept>

#include "program.hpp"

namespace shape3d::apps {

std::vector<descriptors::Descriptor> parse_descriptors(const std::vector<std::string>& specs) {
  std::vector<descriptors::Descriptor> result;
  std::set<std::string> seen;
  for (const std::string& spec : specs) {
    try {
      result.push_back(descriptors::Descriptor::parse(spec));
    } catch (const std::invalid_argument& error) {
      throw UsageError("--descriptor " + spec + ": " + error.what());
    }
    if (!seen.insert(result.back().to_string()).second) {
      throw UsageError("--descriptor " + spec + " is given twice");
    }
  }
  return result;
}

}  // namespace shape3d::apps
