// Snapshots of runs in files: they are read back unchanged, and refused if they cannot be used. Continuation of runs:
// tests/cases/rigid_integrators_test.cpp, rigid_recursive_test.cpp.
#include <polybody/io/checkpoint.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <polybody/integrators/generalised_alpha.hpp>
#include <polybody/joints/policies/policy.hpp>

#include "support/refusal.hpp"
#include "support/resumed_run.hpp"

namespace checkpoint_test {

namespace fs = std::filesystem;
using namespace polybody;

std::string text_of(fs::path const& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}
void put(fs::path const& file, std::string const& text) { std::ofstream(file, std::ios::binary) << text; }

struct Checkpoints : testing::Test {
  fs::path const folder = fs::path(testing::TempDir()) / ("polybody checkpoint " + std::to_string(::getpid()));
  fs::path const file = folder / "run.checkpoint";
  ~Checkpoints() override { fs::remove_all(folder); }
};

/// A snapshot with every kind of content, including numbers that are difficult to write.
RunSnapshot rich() {
  RunSnapshot s{.model = {3, 2, 1, 0, 0xfedcba9876543210u},
                .integrator = "Some method",
                .step = 1e-3,
                .row = {0.25, 1e-3, 7.0},
                .sides = {-1, 0, 1}};
  s.state = {VecX::LinSpaced(3, 0.1, 0.3),
             Vec2(-0.0, 5e-324),
             Vec2(1e308, 1.0 / 3.0),
             VecX::Constant(1, std::nan("")),
             0.7,
             {}};
  static_cast<RunCounts&>(s.report) = {
      .steps = 10, .iterations = 21, .factorisations = 3, .evaluations = 22, .rejected = 1, .halved = 1};
  s.report.last = {
      .taken = 1e-3, .next = 2e-3, .iterations = 2, .factorisations = 1, .evaluations = 2, .rejected = 1, .halved = 1};
  s.report.last.order = 5;
  s.report.last.contraction = 0.1;
  s.report.over_budget = 2;
  s.report.left = 30.0;
  s.report.last.left = 20.0;
  s.report.events = {{"stop", 0.25}};
  s.report.stopped = true;
  s.report.redundant = {"pin", std::string("a\0b", 3)};
  s.report.warnings = {"", "ρ∞"};
  return s;
}

TEST_F(Checkpoints, ReadBackAsTheyWere) {
  RunSnapshot const s = rich();
  write_checkpoint(file, s);
  RunSnapshot const back = read_checkpoint(file);
  EXPECT_EQ(back.model, s.model);
  EXPECT_EQ(back.integrator, s.integrator);
  EXPECT_EQ(bits(back.state), bits(s.state));
  EXPECT_EQ(back.step, s.step);
  EXPECT_EQ(back.sides, s.sides);
  EXPECT_EQ(back.row.end(), s.row.end());
  EXPECT_EQ(back.row.count, 7.0);
  expect_same(back.report, s.report);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1);  // no temporary file
}

// FNV-1a of "", "a" and "foobar": test vectors of draft-eastlake-fnv. The file contains bytes of texts as numbers
// from 0 to 255, for signed and unsigned char.
TEST_F(Checkpoints, KeepTextsWithoutSigns) {
  write_checkpoint(file, rich());
  EXPECT_NE(text_of(file).find(std::string("\xCF\0\0\0\0\0\0\0\x81\0\0\0\0\0\0\0", 16)), std::string::npos);  // ρ
}

TEST_F(Checkpoints, AreSummedUpByFnv) {
  EXPECT_EQ(checksum(""), 0xcbf29ce484222325u);
  EXPECT_EQ(checksum("a"), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(checksum("foobar"), 0x85944171f73967e8u);
}

TEST_F(Checkpoints, AFolderIsNoCheckpoint) {
  std::string const folder = std::filesystem::path(file).parent_path().string();
  EXPECT_TRUE(has(message_of<IoError>([&] { read_checkpoint(folder); }), "cannot be read"));
}

TEST_F(Checkpoints, EveryDamageIsNoticed) {
  write_checkpoint(file, rich());
  std::string const good = text_of(file);
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = char(bad[i] ^ (1 << (i % 8)));
    put(file, bad);
    EXPECT_THROW(read_checkpoint(file), IoError) << "byte " << i;
  }
  for (std::size_t length = 0; length < good.size(); ++length) {
    put(file, good.substr(0, length));
    EXPECT_THROW(read_checkpoint(file), IoError) << length << " bytes";
  }
  auto const told = [&](std::string const& text) {
    put(file, text);
    return message_of<IoError>([&] { read_checkpoint(file); });
  };
  auto const changed = [&](std::size_t at, char to) {
    std::string bad = good;
    bad[at] = to;
    return told(bad);
  };
  EXPECT_TRUE(has(told("t,x\n0,1\n"), "is not a checkpoint of polybody"));
  EXPECT_TRUE(has(told(good.substr(0, 20)), "truncated within its first"));
  std::string const size = std::to_string(good.size()), longer = std::to_string(good.size() + 1);
  EXPECT_TRUE(has(told(good + "x"), "has " + longer + " bytes instead of " + size));
  std::string other = good;
  std::uint32_t const nine = 9;
  std::memcpy(other.data() + 12, &nine, sizeof nine);
  EXPECT_TRUE(has(told(other), "is of version 9, but this program reads version 6"));
  other = good;
  std::reverse(other.begin() + 8, other.begin() + 12);
  EXPECT_TRUE(has(told(other), "another byte order"));
  EXPECT_TRUE(has(changed(good.size() / 2, 'x'), "damaged"));
  fs::remove(file);
  EXPECT_TRUE(has(message_of<IoError>([&] { read_checkpoint(file); }), "cannot be read"));
}

// The checkpoint of a run with an event, in the middle of the run. Each byte is set to other values, and the file is
// cut at every length.
TEST_F(Checkpoints, OfARunNoticeEveryDamage) {
  Chain<InPlane<Constraint>> const chain(2, bar_link());
  auto const height = [&](State const& x) {
    return position(chain.model, x, InPlane<Constraint>::at(chain.links[0], 1.0))[1];
  };
  State x = chain.model.reference_state();
  auto run = simulate(chain.model, x, GeneralisedAlpha{},
                      {.end_time = 1.0, .step = 0.004, .events = {{.name = "falls", .value = height}}});
  for (int k = 0; k < 20; ++k) run.advance();
  write_checkpoint(file, run.snapshot());
  std::string const good = text_of(file);
  auto const noticed = [&] { return !message_of<IoError>([&] { read_checkpoint(file); }).empty(); };
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  auto const set = [&](std::size_t i, char to) { stream.seekp(std::streamoff(i)).put(to).flush(); };
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int const bits : {0x01, 0x80, 0xff}) {
      set(i, char(good[i] ^ bits));
      ASSERT_TRUE(noticed()) << "byte " << i << " of " << good.size() << " differs in the bits " << bits;
    }
    set(i, good[i]);
  }
  EXPECT_EQ(bits(read_checkpoint(file).state), bits(x));
  for (std::size_t length = good.size(); length-- > 0;) {
    fs::resize_file(file, length);
    ASSERT_TRUE(noticed()) << length << " bytes of " << good.size();
  }
}

// Head and checksum are correct, the content between them is not.
TEST_F(Checkpoints, OfInconsistentContentAreRefused) {
  write_checkpoint(file, rich());
  std::string const good = text_of(file);
  auto const told = [&](auto const& change) {
    std::string bad = good.substr(0, good.size() - 8);
    change(bad);
    std::uint64_t const length = bad.size() - sizeof(detail::CheckpointHead);
    std::memcpy(bad.data() + 16, &length, sizeof length);
    std::uint64_t const sum = checksum(bad);
    put(file, bad.append(reinterpret_cast<char const*>(&sum), sizeof sum));
    return message_of<IoError>([&] { read_checkpoint(file); });
  };
  auto const number = [&](std::size_t at, std::int64_t to) {
    return told([&](std::string& bad) { std::memcpy(bad.data() + at, &to, sizeof to); });
  };
  std::size_t const begin = sizeof(detail::CheckpointHead);
  std::string const inconsistent = "checkpoint \"" + file.string() + "\" is inconsistent: ";
  EXPECT_TRUE(has(number(begin, 4), inconsistent + "it has 3 coordinates, but the model has 4. Write it again."));
  EXPECT_TRUE(has(number(begin + 8, 1), inconsistent + "it has 2 velocities, but the model has 1."));
  EXPECT_TRUE(has(number(begin + 16, 0), inconsistent + "it has 1 multipliers, but the model has 0."));
  // estimates of eliminated constraint equations follow those of the state: for all equations, or for none
  EXPECT_TRUE(has(told([&](std::string& bad) {
                    std::int64_t const rows[2] = {0, 2};
                    std::memcpy(bad.data() + begin + 16, rows, sizeof rows);
                  }),
                  inconsistent + "it has 1 multipliers, but the model has 2."));
  EXPECT_TRUE(has(number(begin + 48, 300), inconsistent + "300 exceeds the range of its number type."));  // a letter
  EXPECT_TRUE(has(number(begin + 40, -1), "truncated within its content"));
  EXPECT_TRUE(has(number(begin + 40, std::int64_t(1) << 60), "truncated within its content"));
  EXPECT_TRUE(has(told([](std::string& bad) { bad += "12345678"; }), inconsistent + "8 bytes follow its content."));
  EXPECT_TRUE(has(told([](std::string& bad) { bad.resize(bad.size() - 8); }), "truncated within its content"));
}

// Chains of four and of three links in the plane: 3 coordinates and 2 constraint equations each.
TEST_F(Checkpoints, OfAnotherRunAreRefused) {
  Chain<InPlane<Constraint>> const chain(4, bar_link()), shorter(3, bar_link());
  Chain<InPlane<Constraint>>::ModelType renamed;
  for (int i = 0; i < 4; ++i) {
    auto const link = renamed.add(planar::Rigid(1.0, 0.1), "link " + std::to_string(i));
    renamed.connect(InPlane<Constraint>::hinge({}), renamed.ground().at({0, 0, 0}), link.at(Vec2(0, 0)));
  }
  ModelIdentity const right = identity_of(System(chain.model));
  RunSnapshot const s{.model = right, .integrator = "Radau", .sides = {1}};
  s.require(right, "Radau", 1);
  auto const told = [&](ModelIdentity const& model, std::string const& integrator, std::size_t events) {
    return refusal([&] { s.require(model, integrator, events); });
  };
  EXPECT_TRUE(has(told(identity_of(System(shorter.model)), "Radau", 1),
                  "12 coordinates, 12 generalised velocities and 8 constraint equations; this model has 9 coordinates, "
                  "9 generalised velocities and 6 constraint equations"));
  EXPECT_TRUE(has(told(identity_of(System(renamed)), "Radau", 1), "other names"));
  EXPECT_TRUE(has(told(right, "Newmark", 1), "belongs to a run by Radau, not by Newmark"));
  EXPECT_TRUE(has(told(right, "Radau", 2), "with 1 events, but the options have 2"));
}

}  // namespace checkpoint_test
