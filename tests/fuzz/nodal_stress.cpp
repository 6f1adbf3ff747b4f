// Stress at named nodes of a structure of three nodes. The input consists of a file of names and a matrix, separated
// by a line "====". An accepted result has six finite rows for each name, and the names differ. It is written and
// read again with the same result.
#include <polybody/stress/nodal_stress.hpp>

#include "fuzz/lines.hpp"

namespace polybody::fuzz {

void check(NodalStress const& stress, std::string_view names) {
  require(stress.coordinates() == 9, "it has the coordinates that were asked for");
  require(stress.matrix().rows() == 6 * Index(stress.spots().size()), "each node has six rows");
  require(words_of_lines(names, '#').size() == stress.spots().size(), "there is a node for each line");
  MatX const m = stress.matrix();
  require(m.allFinite(), "entries are finite");
  std::string again = "%%MatrixMarket matrix coordinate real general\n" + std::to_string(m.rows()) + " 9 " +
                      std::to_string(m.size()) + '\n';
  for (Index i = 0; i < m.rows(); ++i)
    for (Index j = 0; j < 9; ++j)
      again += std::to_string(i + 1) + ' ' + std::to_string(j + 1) + ' ' + digits(m(i, j)) + '\n';
  std::string lines;
  for (NodalStress::Spot const& spot : stress.spots()) {
    require(spot.node >= 0 && spot.node < 3, "nodes exist");
    require(stress.of(spot.name, VecX::Zero(9)).size() == 1, "a node is found by its name");
    lines += std::to_string(spot.node) + ' ' + spot.name + '\n';
  }
  NodalStress const second = NodalStress::read(folder().put("again.mtx", again), folder().put("again.txt", lines), 9);
  require(MatX(second.matrix()) == m, "a matrix that is written is read as the same");
  for (std::size_t i = 0; i < stress.spots().size(); ++i)
    require(second.spots()[i].name == stress.spots()[i].name, "names that are written are read as the same");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::string_view const text = text_of(data, size);
  std::size_t const end = std::min(text.find("====\n"), text.size());
  std::string const names = folder().put("names.txt", text.substr(0, end)),
                    matrix = folder().put("stress.mtx", text.substr(std::min(end + 5, text.size())));
  auto const stress =
      accepted([&] { return polybody::NodalStress::read(matrix, names, 9); },
               [&](std::string const& message) {
                 return message.starts_with(names + ", line ") || message.starts_with(matrix + ", line ");
               });
  if (stress) check(*stress, text.substr(0, end));
  return 0;
}
