#pragma once
/// \file Writers of finite element models in the text formats of four programs. A writer uses labels that are not
/// successive, and writes nodes and equations in another order than that of the labels.

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polybody/fe_matrices.hpp>

namespace polybody {

/// Files of one model in a folder that the destructor removes.
class FeFiles {
 public:
  explicit FeFiles(std::string const& name)
      : folder_(std::filesystem::path(testing::TempDir()) / ("polybody_fe_" + name)) {
    std::filesystem::create_directories(folder_);
  }
  ~FeFiles() { std::filesystem::remove_all(folder_); }
  FeFiles(FeFiles const&) = delete;
  FeFiles& operator=(FeFiles const&) = delete;

  std::string path(std::string const& name) const { return (folder_ / name).string(); }
  /// Writes a file and returns its path.
  std::string put(std::string const& name, std::string const& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

namespace fe {

template <class... T>
std::string print(char const* format, T... values) {
  char text[200];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

inline Index label(Index node) { return 10 + 3 * node; }
/// Order of the nodes in the files: the last one first.
inline Index place(Index k, Index count) { return count - 1 - k; }

/// Number of sixteen characters in Nastran's notation without the letter E.
inline std::string nastran_number(double x) {
  std::string text = print("%.9e", x);
  std::size_t const e = text.find('e');
  int const power = std::stoi(text.substr(e + 1));
  return print("%16s", (text.substr(0, e) + print("%+d", power)).c_str());
}

/// Calls `write(i, j, value)` for each entry with i ≥ j, column by column; with `full`, for all entries.
inline void each_entry(Structure::Sparse const& m, bool full, std::function<void(Index, Index, double)> const& write) {
  for (Index j = 0; j < m.outerSize(); ++j)
    for (Structure::Sparse::InnerIterator it(m, j); it; ++it)
      if (full || it.row() >= j) write(it.row(), j, it.value());
}

inline std::string lines_of_nodes(std::vector<Vec3> const& nodes, std::string const& head, char const* format,
                                  std::string const& tail = "") {
  std::string text = head;
  Index const n = Index(nodes.size());
  for (Index k = 0; k < n; ++k) {
    Vec3 const& r = nodes[std::size_t(place(k, n))];
    char line[200];
    std::snprintf(line, sizeof line, format, label(place(k, n)), r[0], r[1], r[2]);
    text += line;
  }
  return text + tail;
}

inline std::string abaqus_nodes(std::vector<Vec3> const& nodes) {
  return lines_of_nodes(nodes, "*HEADING\n bar\n** comment\n*Node, nset=ALL\n", "%td, %.17g, %.17g, %.17g\n",
                        "*ELEMENT, TYPE=C3D8, ELSET=E\n1, 1, 2\n");
}
inline std::string abaqus_labels(Structure::Sparse const& m) {
  std::string text;
  each_entry(m, false, [&](Index i, Index j, double x) {
    text += print("%td,%td, %td,%td,  %.15e\n", label(i / 3), i % 3 + 1, label(j / 3), j % 3 + 1, x);
  });
  return text;
}
inline std::string abaqus_coordinates(Structure::Sparse const& m) {
  std::string text;
  each_entry(m, true, [&](Index i, Index j, double x) { text += print("%td %td %.15e\n", i + 1, j + 1, x); });
  return text;
}

inline std::string grid_large(std::vector<Vec3> const& nodes) {
  return lines_of_nodes(nodes, "SOL 103\nCEND\nBEGIN BULK\n$ nodes\n",
                        "GRID*   %16td                %16.9E%16.9E\n*       %16.9E\n", "ENDDATA\n");
}
inline std::string grid_free(std::vector<Vec3> const& nodes) {
  return lines_of_nodes(nodes, "BEGIN BULK\n", "GRID,%td,,%.17g,%.17g,%.17g\n");
}
inline std::string dmig_large(Structure::Sparse const& m, std::string const& name) {
  std::string text = print("DMIG    %-8s       0       6       2       0\n", name.c_str());
  Index column = -1;
  each_entry(m, false, [&](Index i, Index j, double x) {
    if (j != column) text += print("DMIG*   %-16s%16td%16td\n", name.c_str(), label(j / 3), j % 3 + 1);
    column = j;
    text += print("*       %16td%16td", label(i / 3), i % 3 + 1) + nastran_number(x) + "\n";
  });
  return text;
}
inline std::string dmig_free(Structure::Sparse const& m, std::string const& name) {
  std::string text = "DMIG," + name + ",0,6,2,0\n";
  each_entry(m, false, [&](Index i, Index j, double x) {
    text +=
        print("DMIG,%s,%td,%td,,%td,%td,%.15E\n", name.c_str(), label(j / 3), j % 3 + 1, label(i / 3), i % 3 + 1, x);
  });
  return text;
}

/// Layouts of the columns of OP4.
enum class Op4 { dense, strings, wide_strings };

/// OP4 matrix with three or six components per node; double precision, with numbers or words as lengths.
inline std::string op4(Structure::Sparse const& m, std::string const& name, Op4 layout, Index components, Index words) {
  Index const n = m.rows() / 3 * components;
  std::string text =
      print("%8td%8td%8d%8d%-8s1P,3E23.16\n", n, layout == Op4::wide_strings ? -n : n, 6, 2, name.c_str());
  MatX const full(m);
  auto const numbers = [&](Index row, Index count, Index j) {
    std::string lines;
    for (Index k = 0; k < count; ++k) {
      Index const i = row + k, c = i % components;
      lines += print("%23.16E", c < 3 ? full(3 * (i / components) + c, j) : 0.0);
      if (k % 3 == 2 || k + 1 == count) lines += "\n";
    }
    return lines;
  };
  for (Index j = 0; j < m.cols(); ++j) {
    Index const column = components * (j / 3) + j % 3;
    if (layout == Op4::dense) {
      text += print("%8td%8d%8td\n", column + 1, 1, words * n) + numbers(0, n, j);
      continue;
    }
    text += print("%8td%8d%8td\n", column + 1, 0, 2 * n);  // the total is not used
    for (Index row = 0; row < n; row += components)
      text += (layout == Op4::wide_strings ? print("%8td%8td\n", words * 3 + 1, row + 1)
                                           : print("%12td\n", 65536 * (words * 3 + 1) + row + 1)) +
              numbers(row, 3, j);
  }
  return text + print("%8td%8d%8d\n", n + 1, 1, 1) + " 1.0000000000000000E+00\n";
}

/// Equations of a file whose first node is the last one.
inline Index equation(Index i, Index n) { return 3 * place(i / 3, n / 3) + i % 3; }

inline std::string calculix_dof(Index nodes) {
  std::string text;
  for (Index k = 0; k < 3 * nodes; ++k) text += print("%td.%td\n", label(place(k / 3, nodes)), k % 3 + 1);
  return text;
}
inline std::string calculix_triangle(Structure::Sparse const& m) {
  std::string text;
  each_entry(m, true, [&](Index i, Index j, double x) {
    Index const a = equation(i, m.rows()), b = equation(j, m.rows());
    if (a <= b) text += print("%td %td %21.13e\n", a + 1, b + 1, x);
  });
  return text;
}

inline std::string ansys_mapping(Index nodes) {
  std::string text = "    Matrix Eqn          Node    DOF     \n";
  for (Index k = 0; k < 3 * nodes; ++k)
    text += print("%14td%14td    U%c      \n", k + 1, label(place(k / 3, nodes)), "XYZ"[k % 3]);
  return text;
}
inline std::string nblock(std::vector<Vec3> const& nodes) {
  return lines_of_nodes(nodes, "/PREP7\nNBLOCK,6,SOLID,       20,       20\n(3i9,6e21.13e3)\n",
                        "%9td        0        0%21.13E%21.13E%21.13E\n", "N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID\n");
}
inline std::string nlist(std::vector<Vec3> const& nodes) {
  return lines_of_nodes(nodes,
                        "\n LIST ALL SELECTED NODES.   DSYS=      0\n SORT TABLE ON  NODE  NODE  NODE\n\n"
                        "   NODE        X                   Y                   Z\n",
                        "%9td %20.13g %20.13g %20.13g\n");
}
/// Lower triangle of the equations, one number on a line.
inline std::string harwell_boeing(Structure::Sparse const& m) {
  Index const n = m.rows();
  Structure::Sparse turned(n, n);
  std::vector<Eigen::Triplet<double>> entries;
  each_entry(m, true, [&](Index i, Index j, double x) {
    if (equation(i, n) >= equation(j, n)) entries.emplace_back(int(equation(i, n)), int(equation(j, n)), x);
  });
  turned.setFromTriplets(entries.begin(), entries.end());
  std::string starts, rows, values;
  Index count = 0;
  for (Index j = 0; j < n; ++j) {
    starts += print("%14td\n", count + 1);
    for (Structure::Sparse::InnerIterator it(turned, j); it; ++it, ++count)
      rows += print("%14td\n", it.row() + 1), values += print("%25.15E\n", it.value());
  }
  starts += print("%14td\n", count + 1);
  return "Stiffness matrix from ANSYS FULL file dumped into Harwell-Boeing format         \n" +
         print("%14td%14td%14td%14td%14d\n", n + 1 + 2 * count, n + 1, count, count, 0) +
         print("RSA           %14td%14td%14td%14d\n", n, n, count, 0) +
         "(I14)           (I14)           (d25.15)            (d25.15)            \n" + starts + rows + values;
}

}  // namespace fe
}  // namespace polybody
