// Structures from three files: nodes, mass and stiffness, separated in the input by lines "====". An accepted
// structure has a finite, positive mass, finite moments and symmetric matrices.
#include <polybody/bodies/ffr/matrix_structure.hpp>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

bool finite(Structure::Sparse const& m) {
  for (Index j = 0; j < m.outerSize(); ++j)
    for (Structure::Sparse::InnerIterator it(m, j); it; ++it)
      if (!std::isfinite(it.value())) return false;
  return true;
}

void check(Structure const& s) {
  require(s.mass > 0.0 && std::isfinite(s.mass), "the mass is positive and finite");
  require(s.first.allFinite() && s.second.allFinite(), "moments of the mass are finite");
  for (std::size_t l = 0; l < 3; ++l) {
    require(s.translation[l].allFinite(), "integrals of the shapes are finite");
    for (std::size_t k = 0; k < 3; ++k) require(s.moment[k][l].allFinite(), "moments of the shapes are finite");
  }
  for (auto const& m : s.inertia) require(finite(m), "the inertia is finite");
  require(finite(s.stiffness), "the stiffness is finite");
  Structure::Sparse const turned = s.stiffness.transpose();
  require((MatX(s.stiffness) - MatX(turned)).isZero(0.0), "the stiffness is symmetric");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::string_view rest = text_of(data, size);
  std::string files[3];
  for (int i = 0; i < 3; ++i) {
    std::size_t const end = std::min(rest.find("====\n"), rest.size());
    files[i] = folder().put(std::string("file ") + "nmk"[i], rest.substr(0, end));
    rest.remove_prefix(std::min(end + 5, rest.size()));
  }
  auto const structure = accepted([&] { return polybody::read_structure(files[1], files[2], files[0]); },
                                  [&](std::string const& message) {
                                    for (std::string const& file : files)
                                      if (message.starts_with(file + ", line ")) return true;
                                    return message.starts_with(files[1] + ", " + files[2] + ", " + files[0] + ": ");
                                  });
  if (structure) check(*structure);
  return 0;
}
