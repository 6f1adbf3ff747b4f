// Files of finite element programs: layouts of public samples, and the sentence for each fault. One node has the
// label 7; its matrix is 3×3. The layouts agree with these samples: blockC3D4_STIF1.mtx of jgerstmayr/EXUDYN (Abaqus),
// op4/test/mat_t_s2.op4 of SteveDoyle2/pyNastran (OP4), STIFF_ANSYS.HB and .mapping of fjramireg/StiffMa (Ansys).
#include <polybody/fe_matrices.hpp>

#include "support/fe_files.hpp"
#include "support/refusal.hpp"

namespace polybody {
namespace fe_files_test {

FeNodes one_node() { return {"nodes", {7}, {Vec3(0, 0, 0)}}; }
FeNodes two_nodes() { return {"nodes", {7, 9}, {Vec3(0, 0, 0), Vec3(1, 0, 0)}}; }

/// A folder, and the messages of the readers for a text. The messages begin with the path of the file.
struct FeReaders : testing::Test {
  FeFiles const files{testing::UnitTest::GetInstance()->current_test_info()->name()};
  std::string file = files.path("file");

  template <class Read>
  std::string refused(std::string const& text, Read&& read) const {
    files.put("file", text);
    std::string const message = message_of<IoError>(read);
    EXPECT_TRUE(message.starts_with(file + ", line ")) << message;
    return message.substr(std::min(message.size(), file.size() + 7));
  }
  std::string abaqus(std::string const& text) const {
    return refused(text, [&] { read_abaqus_matrix(file, one_node()); });
  }
  std::string abaqus_nodes(std::string const& text) const {
    return refused(text, [&] { read_abaqus_nodes(file); });
  }
  std::string dmig(std::string const& text) const {
    return refused(text, [&] { read_dmig_matrix(file, "K", one_node()); });
  }
  std::string grid(std::string const& text) const {
    return refused(text, [&] { read_nastran_nodes(file); });
  }
  std::string op4(std::string const& text) const {
    return refused(text, [&] { read_op4_matrix(file, "K", one_node()); });
  }
  std::string frd(std::string const& text) const {
    return refused(text, [&] { read_calculix_nodes(file); });
  }
  std::string ansys_nodes(std::string const& text) const {
    return refused(text, [&] { read_ansys_nodes(file); });
  }
  MatX read(std::string const& text, std::function<FeMatrix(std::string const&)> const& reader) const {
    return MatX(reader(files.put("file", text)).entries);
  }
};

/// Symmetric 3×3 matrix.
MatX three() {
  MatX m(3, 3);
  m << 4, -1, 0, -1, 5, 2, 0, 2, 6;
  return m;
}

TEST_F(FeReaders, AbaqusReadsBothFormats) {
  auto const reader = [](std::string const& path) { return read_abaqus_matrix(path, one_node()); };
  std::string const labels =
      "** stiffness\n*MATRIX INPUT, NAME=K, TYPE=SYMMETRIC\n7,1, 7,1, 4.0e+00\n7,2,7,1,-1.\n"
      "7,2,7,2,5\n7,3,7,2,2\n7,3,7,3,6\n";
  EXPECT_EQ(read(labels, reader), three());
  EXPECT_EQ(read("1 1  4.0e+00\n1 2 -1.0e+00\n2 1 -1.0e+00\n2 2 5\n2 3 2\n3 2 2\n3 3 6\n", reader), three());
  FeMatrix const half =
      read_abaqus_matrix(files.put("file", "1 1 4\n2 1 -1\n1 2 0\n2 2 5\n3 2 2\n3 3 6\n"), one_node());
  EXPECT_EQ(MatX(half.entries), three());
  ASSERT_EQ(half.remarks.size(), 1u);
  EXPECT_TRUE(has(half.remarks[0], "the upper triangle of the matrix is zero; the matrix is read as a symmetric one"));
}

TEST_F(FeReaders, AbaqusRefusesWithLineAndElement) {
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n8,1,7,1,2\n"), "2: node 8 is not among the 1 nodes of nodes."));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n7,1,7,1\n"), "2: \"7,1,7,1\" is not an entry"));
  EXPECT_TRUE(has(abaqus("7 1 7\n7,1,7,1,4\n"), "1: row or column 7 is outside the matrix, which has 3 rows."));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n7,7,7,1,2\n"), "2: component 7 of node 7 is no displacement"));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n7,4,7,1,2\n"), "2: the entry belongs to a rotation; use solid elements"));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n-3,1,7,1,2\n"), "2: the label -3 belongs to a variable of Abaqus"));
  EXPECT_TRUE(has(abaqus("7,1,7,1,1.0e+36\n"), "1: the entry 1e+36 marks a fixed displacement"));
  EXPECT_TRUE(has(abaqus("7,1,7,1,nan\n"), "1: \"nan\" is not an entry, a finite number."));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n7,2,7,1,1\n7,1,7,1,4\n"),
                  "3: the entry of x of node 7 and x of node 7 occurs a second time, after line 1."));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n7,1,7,2,1\n7,2,7,1,2\n"),
                  "3: the entry of y of node 7 and x of node 7 is 2, but its mirror image is 1"));
  EXPECT_TRUE(has(abaqus("7,1,7,1,4\n7,2,7,2,4\n"), ": the matrix has no diagonal entry of z of node 7."));
  EXPECT_TRUE(has(abaqus("*STEP\n"), "1: *STEP is not expected; the file must contain entries of one matrix"));
  EXPECT_TRUE(has(abaqus("7,1,7,1,1e29\n7,1.5,7,1,1"), "2: \"1.5\" is not a component."));
  EXPECT_TRUE(has(abaqus("7,1,7,1,1e200\n"), "1: the entry 1e+200 marks"));
}

TEST_F(FeReaders, AbaqusNodesAreThoseOfPlainLines) {
  files.put("file",
            "*Heading\n*Part, name=P\n*Node\n  9, 1., 2.5e-1, -3\n  7, 0, 0, 0\n*Element, type=C3D8,\n elset=E\n"
            "1, 7, 9\n*Node, nset=B, system=R\n 8, 4, 5, 6\n");
  FeNodes const n = read_abaqus_nodes(file);
  EXPECT_EQ(n.labels, (std::vector<Index>{7, 8, 9}));
  EXPECT_EQ(n.positions[2], Vec3(1, 0.25, -3));
  EXPECT_EQ(n.index(8), 1);
  EXPECT_TRUE(has(refusal([&] { n.index(3); }), file + ": there is no node 3 among the 3 nodes of the file."));
  EXPECT_TRUE(has(abaqus_nodes("*NODE\n1,2,3\n"), "2: \"1,2,3\" is not label, x, y, z of a node."));
  EXPECT_TRUE(has(abaqus_nodes("*NODE\n1,2,3,4\n1,2,3,5\n"), "3: node 1 occurs a second time, after line 2."));
  EXPECT_TRUE(has(abaqus_nodes("*NODE\n0,2,3,4\n"), "2: the label of a node is positive, but here it is 0."));
  EXPECT_TRUE(has(abaqus_nodes("*NODE\n1,2,3,x\n"), "2: \"x\" is not a coordinate of a node, a finite number."));
  EXPECT_TRUE(has(abaqus_nodes("*NODE, SYSTEM=C\n1,2,3,4\n"), "1: *NODE with SYSTEM=C is not read"));
  EXPECT_TRUE(has(abaqus_nodes("*NODE, INPUT=other\n"), "1: *NODE with INPUT is not read"));
  EXPECT_TRUE(has(abaqus_nodes("*NODE\n1,0,0,0\n*NGEN\n1,2\n"), "3: *NGEN is not read; write every node"));
  EXPECT_TRUE(has(abaqus_nodes("*INSTANCE, NAME=I, PART=P\n0,0,1\n"), "2: the instance of the part is moved"));
  EXPECT_TRUE(has(abaqus_nodes("*ELEMENT\n1,2\n"), ": the file has no nodes: it has no lines after *NODE."));
}

TEST_F(FeReaders, NastranReadsThreeFieldFormats) {
  auto const reader = [](std::string const& path) { return read_dmig_matrix(path, "k", one_node()); };
  std::string const small =
      "$ small field\nDMIG    M              0       6       2       0\n"
      "DMIG    K              0       6       1       0\n"
      "DMIG    K              7       1               7       1      4.             \n"
      "               7       2    -1.0\n"
      "DMIG    K              7       2               7       2    5.+0        +A\n"
      "+A             7       3    2.D0\nDMIG    K              7       3               7       3   0.6+1\n";
  EXPECT_EQ(read(small, reader), three());
  std::string const large =
      "DMIG    K              0       6       2       0\n"
      "DMIG*   K                              7               1\n"
      "*                      7               1 4.000000000D+00\n"
      "*                      7               2-1.000000000D+00\n"
      "DMIG*   K                              7               2\n"
      "*                      7               2 5.000000000D+00\n"
      "*                      7               3 2.000000000D+00\n"
      "DMIG*   K                              7               3\n"
      "*                      7               3 6.000000000D+00\n";
  EXPECT_EQ(read(large, reader), three());
  EXPECT_EQ(read("DMIG,K,0,1,2\nDMIG,K,7,1,,7,1,4.\n,7,2,-1.\nDMIG,K,7,2,,7,2,5.\n,7,1,-1.,,7,3,2.,\n"
                 "DMIG,K,7,3,,7,3,6.\n+,7,2,2.\n",
                 reader),
            three());
  files.put("file",
            "GRID,9,,1.5,.25,-3.+0\nGRID           7             1.0             2.0\n"
            "GRID*                  8                 1.250000000E+00-2.500000000E+00\n*        3.750000000E+00\n");
  FeNodes const n = read_nastran_nodes(file);
  EXPECT_EQ(n.labels, (std::vector<Index>{7, 8, 9}));
  EXPECT_EQ(n.positions[0], Vec3(1, 0, 2));
  EXPECT_EQ(n.positions[1], Vec3(1.25, -2.5, 3.75));
  EXPECT_EQ(n.positions[2], Vec3(1.5, 0.25, -3));
}

TEST_F(FeReaders, NastranRefusesWithLineAndElement) {
  std::string const head = "DMIG,K,0,6,2,0\n";
  EXPECT_TRUE(has(dmig("DMIG,MAAX,0,6,2\nDMIG,MAAX,7,1,,7,1,2.\n"),
                  "the file has no header of a DMIG matrix K; it has the matrices MAAX."));
  EXPECT_TRUE(has(dmig("DMIG,K,0,9,2,0\n"), "1: the form of the matrix is \"9\", but must be 1 (square) or 6"));
  EXPECT_TRUE(has(dmig("DMIG,K,0,6,4,0\n"), "1: the type of the entries is \"4\", but must be 1 or 2 (real)."));
  EXPECT_TRUE(has(dmig(head + head), "2: the matrix K has a second header."));
  EXPECT_TRUE(has(dmig(head + "DMIG,K,7,1,,8,1,2.\n"), "2: node 8 is not among the 1 nodes of nodes."));
  EXPECT_TRUE(has(dmig(head + "DMIG,K,7,,,7,1,2.\n"), "2: \"\" is not a component, 1 to 6."));
  EXPECT_TRUE(has(dmig(head + "DMIG,K,7,0,,7,1,2.\n"), "2: component 0 of node 7 is no displacement"));
  EXPECT_TRUE(has(dmig(head + "DMIG,K,7,5,,7,1,2.\n"), "2: the entry belongs to a rotation"));
  EXPECT_TRUE(has(dmig(head + "DMIG,K,7,1,,7,1,2.x\n"), "2: \"2.x\" is not an entry, a finite number."));
  EXPECT_TRUE(has(dmig(head + "DMIG,K,7,1,,7,1,2.,,7,2,1.,,8\n"), "2: the line has 13 fields, more than 8."));
  EXPECT_TRUE(has(grid("GRID,7,3,0.,0.,0.\n"), "1: GRID 7 has the coordinate system 3; export the nodes in the basic"));
  EXPECT_TRUE(has(grid("GRID,7,,0.,0.,0.,4\n"), "1: GRID 7 has displacements in the coordinate system 4"));
  EXPECT_TRUE(has(grid("GRID,7,,0.,0.,0.,,123\n"), "1: GRID 7 has the constraints 123"));
  EXPECT_TRUE(has(grid("GRID,7,,0.,zero,0.\n"), "1: \"zero\" is not a coordinate of a node"));
  EXPECT_TRUE(has(grid("GRDSET,,3\n"), "1: GRDSET is not read"));
  EXPECT_TRUE(has(grid("INCLUDE 'a.bdf'\n"), "1: INCLUDE is not read"));
  EXPECT_TRUE(has(grid("BEGIN BULK\n"), "the file has no nodes: it has no GRID entries."));
}

std::string const op4_head = "       3       3       6       2K       1P,3E23.16\n";
std::string const op4_tail = "       4       1       1\n 1.0000000000000000E+00\n";

TEST_F(FeReaders, Op4ReadsTheLayoutOfTheSample) {
  auto const reader = [](std::string const& path) { return read_op4_matrix(path, "K", one_node()); };
  std::string const other =
      "       2      -2       6       4EYECD   1P,3E22.15\n       1       0       6\n"
      "       5       2\n-1.000000000000000E+00 1.000000000000000E+00\n"
      "       3       1       1\n 1.000000000000000E+00\n";
  std::string const wide =
      "       3      -3       6       2K       1P,3E23.16\n       1       0       6\n"
      "       5       1\n 4.0000000000000000E+00-1.0000000000000000E+00\n       2       0       8\n"
      "       7       1\n-1.0000000000000000E+00 5.0000000000000000E+00 2.0000000000000000E+00\n"
      "       3       0       6\n       3       2\n 2.0000000000000000E+00\n"
      "       3       3\n 6.0000000000000000E+00\n";
  EXPECT_EQ(read(other + wide + op4_tail, reader), three());
  std::string const lower = op4_head +
                            "       1       1       2\n 4.0000000000000000E+00-1.0000000000000000E+00\n"
                            "       2       2       4\n 5.0000000000000000E+00 2.0000000000000000E+00\n"
                            "       3       3       1\n 6.0000000000000000E+00\n";
  EXPECT_EQ(read(lower + op4_tail, reader), three());
}

TEST_F(FeReaders, Op4RefusesWithLineAndElement) {
  std::string const column = "       1       1       1\n 4.0000000000000000E+00\n";
  EXPECT_TRUE(has(op4("hello\n"), "1: the line is not the header of an OP4 matrix: columns, rows, form, type, name."));
  EXPECT_TRUE(
      has(op4("       3       3       6       2K       no number here\n"), "1: the header of the OP4 matrix K"));
  EXPECT_TRUE(has(op4("       3       3       6       4K       1P,3E23.16\n"), "1: the type of the matrix K is 4"));
  EXPECT_TRUE(has(op4("       5       5       6       2K       1P,3E23.16\n"),
                  "1: the matrix K is 5×5, but 1 nodes need 3×3, or 6×6 with rotations."));
  EXPECT_TRUE(has(op4("       1       1       6       2M       1P,3E23.16\n       2       1       1\n 1.0E+00\n"),
                  "the file has no OP4 matrix K; it has the matrices M."));
  EXPECT_TRUE(has(op4(op4_head + column), "the file ends within the matrix K."));
  EXPECT_TRUE(
      has(op4(op4_head + "       1       1\n"), "2: \"       1       1\" is not column, row and number of words."));
  EXPECT_TRUE(has(op4(op4_head + "       1       1       5\n 4.0E+00\n"),
                  "3: column 1 of the matrix K has 1 numbers from row 1, but declares 5 words."));
  EXPECT_TRUE(has(op4(op4_head + "       1       4       1\n 4.0E+00\n"), "3: row or column 4 is outside the matrix"));
  EXPECT_TRUE(has(op4(op4_head + "       0       1       1\n 4.0E+00\n"), "3: row or column 0 is outside the matrix"));
  EXPECT_TRUE(has(op4(op4_head + "       1       1       1\n 4.0E+0x\n"), "3: \"4.0E+0x\" is not an entry"));
  EXPECT_TRUE(has(op4(op4_head + column + op4_tail), "the matrix has no diagonal entry of y of node 7."));
}

TEST_F(FeReaders, CalculixRefusesWithLineAndElement) {
  auto const told = [&](std::string const& matrix, std::string const& dof) {
    std::string const rows = files.put("rows", dof);
    return refused(matrix, [&] { read_calculix_matrix(file, rows, one_node()); });
  };
  std::string const dof = "7.1\n7.2\n7.3\n";
  EXPECT_TRUE(has(told("1 1\n", dof), "1: \"1 1\" is not row, column, value of an entry."));
  EXPECT_TRUE(has(told("1 4 2.0\n", dof), "1: row or column 4 is outside the matrix, which has 3 rows."));
  EXPECT_TRUE(has(told("1 1 2.0\n2 2 1.0\n", dof), "the matrix has no diagonal entry of z of node 7."));
  auto const rows = [&](std::string const& text) {
    std::string const matrix = files.put("matrix", "1 1 1.0\n");
    return refused(text, [&] { read_calculix_matrix(matrix, file, one_node()); });
  };
  EXPECT_TRUE(has(rows("71\n"), "1: \"71\" is not node.component of a row of the matrix."));
  EXPECT_TRUE(has(rows("8.1\n"), "1: node 8 is not among the 1 nodes of nodes."));
  EXPECT_TRUE(has(rows(""), "the file has no rows: it has no lines node.component."));
  EXPECT_TRUE(has(frd("    1C\n    2C    8    2\n"), "2: the block of nodes must be text"));
  EXPECT_TRUE(has(frd("    1C\n    2C    8    1\n -1         1 0.0\n"), "is not -1, label, x, y, z of a node."));
  EXPECT_TRUE(has(frd("    1C\n"), "the file has no nodes: it has no block 2C."));
}

std::string const hb_head =
    "Stiffness matrix from ANSYS FULL file dumped into Harwell-Boeing format         \n"
    "            14             4             5             5             0\n";
std::string const hb_formats = "(4I8)           (5I8)           (1P,3E12.4)         \n";

TEST_F(FeReaders, AnsysReadsHarwellBoeing) {
  std::string const mapping = files.put("map",
                                        "    Matrix Eqn          Node    DOF     \n             1             7    UZ\n"
                                        "             2             7    UX\n             3             7    UY\n");
  auto const reader = [&](std::string const& path) { return read_ansys_matrix(path, mapping, one_node()); };
  // equations z, x, y of the matrix `three`: 6, 0, 2; 4, −1; 5
  EXPECT_EQ(read(hb_head + "RSA                        3             3             5             0\n" + hb_formats +
                     "       1       3       5       6\n       1       3       2       3       3\n"
                     "  6.0000E+00  2.0000E+00  4.0000E+00\n -1.0000D+00  5.0000E+00\n",
                 reader),
            three());
  auto const told = [&](std::string const& text) {
    return refused(text, [&] { read_ansys_matrix(file, mapping, one_node()); });
  };
  std::string const size = "RSA                        3             3             5             0\n",
                    all = hb_head + size;
  EXPECT_TRUE(
      has(told(hb_head + "PSA" + size.substr(3)), "3: the type of the matrix is \"PSA\", but must be RSA or RUA"));
  EXPECT_TRUE(has(told(hb_head + "RSA    3  2  5\n"), "3: the matrix is 3×2 with 5 entries, but must be square."));
  EXPECT_TRUE(has(told(hb_head + "RSA    3  3\n"), "3: the line lacks the numbers of rows, columns and entries."));
  EXPECT_TRUE(has(told(all + "(4X8)   \n"), "4: the line must have formats such as (10I8) (10I8) (3D25.15)."));
  EXPECT_TRUE(has(told(all), "the file ends before the formats."));
  std::string const head = all + hb_formats, starts = "       1       3       5       6\n";
  EXPECT_TRUE(has(told(head + "       1       3       2       6\n"), "5: column 2 starts behind the next one."));
  EXPECT_TRUE(has(told(head + "       1       3       5       7\n"),
                  "5: the columns contain entries 1 to 6, but the matrix has entries 1 to 5."));
  EXPECT_TRUE(has(told(head + starts + "       1       9       2       3       3\n"), "6: row or column 9 is outside"));
  EXPECT_TRUE(has(told(head + starts + "       1       3       2       3       3\n  6.0000E+00\n"),
                  "the file ends after 1 of 5 numbers; it is truncated."));
  EXPECT_TRUE(has(told(head + "       1       3       5      x6\n"), "5: \"x6\" is not the start of a column."));
  EXPECT_TRUE(
      has(told(hb_head + "RSA                        2             2             5             0\n" + hb_formats),
          "the matrix has 2 rows, but "));
}

TEST_F(FeReaders, AnsysRefusesOtherUnknownsAndRotatedNodes) {
  auto const told = [&](std::string const& text) {
    return refused(text, [&] { read_ansys_matrix("none", file, one_node()); });
  };
  std::string const head = "    Matrix Eqn          Node    DOF     \n";
  EXPECT_TRUE(has(told(head + "             1             7    TEMP\n"),
                  "2: \"TEMP\" is no displacement; the names are UX, UY and UZ."));
  EXPECT_TRUE(has(told(head + "             2             7    UX\n"),
                  "2: the equation 2 is out of order; the next one is 1."));
  EXPECT_TRUE(has(told(head + "             1             8    UX\n"), "2: node 8 is not among the 1 nodes of nodes."));
  EXPECT_TRUE(has(told(head + "   1   7\n"), "2: \"   1   7\" is not equation, node and name of a displacement."));
  EXPECT_TRUE(has(told(head), "the file has no lines with equation, node and name of a displacement."));
  files.put("file",
            "NBLOCK,6,SOLID\n(3i9,6e21.13e3)\n        9        0        0 1.0000000000000E+000\n"
            "        7        0        0\n-1\n");
  FeNodes const n = read_ansys_nodes(file);  // zeros at the end of a line are missing
  EXPECT_EQ(n.labels, (std::vector<Index>{7, 9}));
  EXPECT_EQ(n.positions[1], Vec3(1, 0, 0));
  EXPECT_TRUE(
      has(ansys_nodes("NBLOCK,6,SOLID\n(3i9)\n"), "2: \"(3i9)\" is not a format of NBLOCK such as (3i9,6e21.13e3)."));
  EXPECT_TRUE(
      has(ansys_nodes("NBLOCK,6\n(1i3,6e4.1)\n  7 1.0 2.0 3.0 0.0 0.0 9.0\n-1\n"), "3: node 7 has rotated axes"));
  EXPECT_TRUE(has(ansys_nodes("  NODE  X  Y  Z\n 1 0.0 0.0\n"), "2: \" 1 0.0 0.0\" is not node, x, y, z"));
  EXPECT_TRUE(has(ansys_nodes("  NODE  X  Y  Z\n 1 0.0 0.0 a\n"), "2: \"a\" is not a coordinate of a node"));
  EXPECT_TRUE(has(ansys_nodes("/PREP7\n"), "the file has no nodes: it has no NBLOCK and no table NODE X Y Z."));
}

TEST_F(FeReaders, MatrixMarketWithOneTriangleIsReadAsSymmetricAndReported) {
  std::string const lower = "3 3 5\n1 1 4\n2 1 -1\n2 2 5\n3 2 2\n3 3 6\n";
  FeMatrix m =
      read_matrix_market(files.put("file", "%%MatrixMarket matrix coordinate real general\n" + lower), one_node());
  EXPECT_EQ(MatX(m.entries), three());
  ASSERT_EQ(m.remarks.size(), 1u);
  EXPECT_TRUE(
      has(m.remarks[0], file + ": the upper triangle of the matrix is zero; the matrix is read as a symmetric one"));
  m = read_matrix_market(files.put("file", "%%MatrixMarket matrix coordinate real symmetric\n" + lower), one_node());
  EXPECT_EQ(MatX(m.entries), three());
  EXPECT_TRUE(m.remarks.empty());
  files.put("file", "%%MatrixMarket matrix coordinate real general\n3 3 2\n1 1 4\n2 2 5\n");
  EXPECT_TRUE(has(message_of<IoError>([&] { read_matrix_market(file, one_node()); }),
                  file + ": the matrix has no diagonal entry of z of node 7."));
}

TEST_F(FeReaders, FilesThatCannotBeOpenedAreNamed) {
  std::string const none = files.path("none");
  for (auto const& read : std::vector<std::function<void()>>{
           [&] { read_abaqus_nodes(none); }, [&] { read_nastran_nodes(none); }, [&] { read_calculix_nodes(none); },
           [&] { read_ansys_nodes(none); }, [&] { read_op4_matrix(none, "K", two_nodes()); },
           [&] { read_ansys_matrix(none, none, two_nodes()); }, [&] { read_plain_nodes(none); }})
    EXPECT_TRUE(has(message_of<IoError>(read), none + ": the file cannot be opened"));
}

}  // namespace fe_files_test
}  // namespace polybody
