// Matrices of finite element programs for the nodes 7 and 9. The first letter selects the reader: A (Abaqus), D (DMIG),
// O (OP4), C (CalculiX), H (Ansys), any other (Matrix Market). The input of C and H begins with the .dof or mapping
// file, which ends at a line "====". An accepted matrix is finite, has a diagonal, and is written and read again with
// the same result. A matrix of a symmetric format is symmetric.
#include <polybody/fe_matrices.hpp>

#include "fuzz/lines.hpp"

namespace polybody::fuzz {

FeNodes const& nodes() {
  static FeNodes const two{"nodes", {7, 9}, {Vec3(0, 0, 0), Vec3(1, 0, 0)}};
  return two;
}

FeMatrix read(char program, std::string const& file, std::string const& rows) {
  switch (program) {
    case 'A':
      return read_abaqus_matrix(file, nodes());
    case 'D':
      return read_dmig_matrix(file, "K", nodes());
    case 'O':
      return read_op4_matrix(file, "K", nodes());
    case 'C':
      return read_calculix_matrix(file, rows, nodes());
    case 'H':
      return read_ansys_matrix(file, rows, nodes());
    default:
      return read_matrix_market(file, nodes());
  }
}

void check(FeMatrix const& m, bool symmetric) {
  require(m.entries.rows() == 6 && m.entries.cols() == 6, "the matrix has three rows for each node");
  MatX const full(m.entries);
  require(full.allFinite(), "entries are finite");
  double const largest = full.cwiseAbs().maxCoeff();
  if (symmetric) require((full - full.transpose()).cwiseAbs().maxCoeff() <= 1e-9 * largest, "the matrix is symmetric");
  std::string again;
  for (Index i = 0; i < 6; ++i) {
    require(full(i, i) != 0.0, "the diagonal has entries");
    for (Index j = 0; j < 6; ++j)
      again += std::to_string(i + 1) + ' ' + std::to_string(j + 1) + ' ' + digits(full(i, j)) + '\n';
  }
  if (largest >= 1e30) return;  // the mark of a fixed displacement
  require(MatX(read_abaqus_matrix(folder().put("again", again), nodes()).entries) == full,
          "a matrix that is written is read as the same");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  if (size == 0) return 0;
  char const program = char(data[0]);
  std::string_view rest = text_of(data + 1, size - 1);
  std::string rows;
  if (program == 'C' || program == 'H') {
    std::size_t const end = std::min(rest.find("====\n"), rest.size());
    rows = folder().put("rows", rest.substr(0, end));
    rest.remove_prefix(std::min(end + 5, rest.size()));
  }
  std::string const file = folder().put("matrix", rest);
  auto const matrix = accepted([&] { return read(program, file, rows); },
                               [&](std::string const& message) {
                                 return message.starts_with(file + ", line ") || message.starts_with(file + ": ") ||
                                        message.starts_with(rows + ", line ");
                               });
  if (matrix) check(*matrix, program == 'C');
  return 0;
}
