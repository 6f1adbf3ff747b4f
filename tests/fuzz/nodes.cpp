// Node files. Each line with words has three words, which are the accepted numbers. They are written and read again
// with the same result.
#include <polybody/bodies/ffr/matrix_structure.hpp>

#include "fuzz/lines.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody;
  using namespace polybody::fuzz;
  std::string const file = folder().put("nodes.txt", text_of(data, size));
  auto const nodes = accepted([&] { return detail::read_nodes(file); },
                              [&](std::string const& message) { return message.starts_with(file + ", line "); });
  if (!nodes) return 0;
  std::vector<std::size_t> const words = words_of_lines(text_of(data, size), '#');
  require(words.size() == nodes->size(), "there is a node for each line");
  for (std::size_t const count : words) require(count == 3, "the line of a node has three words");
  std::string again;
  for (Vec3 const& r : *nodes) {
    require(std::isfinite(r[0]) && std::isfinite(r[1]) && std::isfinite(r[2]), "nodes are finite");
    again += digits(r[0]) + ' ' + digits(r[1]) + '\t' + digits(r[2]) + '\n';
  }
  require(detail::read_nodes(folder().put("again.txt", again)) == *nodes,
          "nodes that are written are read as the same");
  return 0;
}
