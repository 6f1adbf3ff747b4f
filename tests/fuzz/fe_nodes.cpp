// Nodes of finite element programs. The first letter selects the reader: A (Abaqus), N (Nastran), C (CalculiX), any
// other (Ansys). Accepted nodes are finite and sorted by their labels. They are written in Abaqus' format and read
// again with the same result.
#include <polybody/fe_matrices.hpp>

#include "fuzz/lines.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody;
  using namespace polybody::fuzz;
  if (size == 0) return 0;
  std::string const file = folder().put("nodes", text_of(data + 1, size - 1));
  char const program = char(data[0]);
  auto const nodes = accepted(
      [&] {
        return program == 'A'   ? read_abaqus_nodes(file)
               : program == 'N' ? read_nastran_nodes(file)
               : program == 'C' ? read_calculix_nodes(file)
                                : read_ansys_nodes(file);
      },
      [&](std::string const& message) { return message.starts_with(file + ", line "); });
  if (!nodes) return 0;
  require(!nodes->labels.empty() && nodes->labels.size() == nodes->positions.size(),
          "each node has label and position");
  std::string again = "*NODE\n";
  for (std::size_t i = 0; i < nodes->labels.size(); ++i) {
    Vec3 const& r = nodes->positions[i];
    require(nodes->labels[i] > (i == 0 ? 0 : nodes->labels[i - 1]), "the labels are positive and ascend");
    require(r.allFinite(), "positions are finite");
    require(nodes->index(nodes->labels[i]) == Index(i), "a label is found");
    again += std::to_string(nodes->labels[i]) + ',' + digits(r[0]) + ',' + digits(r[1]) + ',' + digits(r[2]) + '\n';
  }
  FeNodes const second = read_abaqus_nodes(folder().put("again", again));
  require(second.labels == nodes->labels && second.positions == nodes->positions,
          "nodes that are written are read as the same");
  return 0;
}
