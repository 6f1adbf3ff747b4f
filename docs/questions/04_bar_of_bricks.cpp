// title: Bar of bricks by its matrices
// thread: https://github.com/projectchrono/chrono/issues/528
// wanted: The stiffness of an 8-node brick is checked. It was halved between two releases.
// inputs: One brick of 1 m, E = 2.1e11 Pa, ν = 0.3, in the files of CalculiX 2.20. A bar of four bricks of 0.1 m,
//     ρ = 7850 kg/m³, consistent mass, in Matrix Market files.
// right: K₁₁ by 2×2×2 Gauss points (printed in the thread). Mass 4 · 0.1³ · 7850. Frequencies: eigenvalues of the
//     matrices by NumPy.
#include <polybody/fe_matrices.hpp>
#include <polybody/ffr.hpp>

#include "answer.hpp"
using namespace polybody;

int main() {
  std::string const folder = "tests/cases/bar_of_bricks/";
  FeNodes const corners = read_calculix_nodes(folder + "brick.inp"),
                nodes = read_plain_nodes(folder + "bar4_nodes.txt");
  FeMatrix const brick = read_calculix_matrix(folder + "brick.sti", folder + "brick.dof", corners);
  answer("stiffness K₁₁ of the brick [N/m]", 49358974358.97, brick.entries.coeff(0, 0), 0.01);
  FeModel const bar{nodes, read_matrix_market(folder + "bar4_M.mtx", nodes),
                    read_matrix_market(folder + "bar4_K.mtx", nodes)};
  answer("mass of the bar [kg]", 31.4, check_matrices(bar, 31.4).mass, 1e-9);
  Structure const s = structure_of(bar, 31.4);
  Ffr const body(s, free_interface_modes(s, s.size() - 6));
  auto const frequency = [&](Index i) {
    return std::sqrt(body.integrals().stiffness(i, i) / body.integrals().mass_matrix(i, i));
  };
  answer("first free frequency [rad/s]", 23048.4111, frequency(0), 1e-3);
  answer("third free frequency [rad/s]", 25844.3572, frequency(2), 1e-3);
  answer("fourth free frequency [rad/s]", 41747.4934, frequency(3), 1e-3);
  return wrong_answers();
}
