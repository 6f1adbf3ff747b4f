// Matrix Market files of 6×6 matrices. Each entry has a line of three words. An accepted matrix is written and read
// again with the same result.
#include <polybody/bodies/ffr/matrix_file.hpp>

#include "fuzz/lines.hpp"

namespace polybody::fuzz {

void check(Eigen::SparseMatrix<double> const& m, std::string_view text) {
  require(m.rows() == 6 && m.cols() == 6, "the matrix has the size that was asked for");
  std::vector<std::size_t> const words = words_of_lines(text.substr(text.find('\n') + 1), '%');
  for (std::size_t const count : words) require(count == 3, "a line after the banner has three words");
  require(words.size() - 1 <= std::size_t(m.nonZeros()), "no line is passed over");
  std::string again = "%%MatrixMarket matrix coordinate real general\n6 6 " + std::to_string(m.nonZeros()) + '\n';
  for (Index j = 0; j < 6; ++j)
    for (Eigen::SparseMatrix<double>::InnerIterator it(m, j); it; ++it) {
      require(std::isfinite(it.value()), "entries are finite");
      again += std::to_string(it.row() + 1) + ' ' + std::to_string(j + 1) + ' ' + digits(it.value()) + '\n';
    }
  Eigen::SparseMatrix<double> const second = read_matrix(folder().put("again.mtx", again), 6, 6, "nodes need 6×6");
  require(second.nonZeros() == m.nonZeros() && MatX(second) == MatX(m), "a matrix that is written is read as the same");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::string const file = folder().put("matrix.mtx", text_of(data, size));
  auto const matrix = accepted([&] { return polybody::read_matrix(file, 6, 6, "nodes need 6×6"); },
                               [&](std::string const& message) { return message.starts_with(file + ", line "); });
  if (matrix) check(*matrix, text_of(data, size));
  return 0;
}
