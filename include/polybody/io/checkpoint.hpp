#pragma once
/// \file
/// Writer and reader of checkpoints, which are snapshots of runs in files. A file consists of "polybody", 0x01020304
/// (byte order), version, length of the content, content, and the `checksum` of all preceding bytes. Numbers have the
/// representation of the machine. Integers of the content are int64.

#include <cstring>

#include <polybody/io/atomic_file.hpp>
#include <polybody/io/text_files.hpp>
#include <polybody/run/run_snapshot.hpp>

namespace polybody {

namespace detail {

/// Visitor of all numbers of a snapshot, in the same order for writing and reading: `archive(x)` writes or reads the
/// number x.
template <class Archive>
class SnapshotVisitor {
 public:
  Archive archive;

  template <class S>
  void walk(S& s) {
    each(s.model.coordinates, s.model.velocities, s.model.rows, s.model.eliminated_equations, s.model.names);
    text(s.integrator);
    numbers(s.state.q), numbers(s.state.v), numbers(s.state.a), numbers(s.state.lambda), numbers(s.state.history);
    each(s.state.t, s.step, s.row.start, s.row.length, s.row.count);
    list(s.sides, [&](auto& side) { archive(side); });
    each(s.report.steps, s.report.iterations, s.report.factorisations, s.report.evaluations, s.report.rejected,
         s.report.halved, s.report.over_budget, s.report.left, s.report.stopped);
    auto& last = s.report.last;
    each(last.taken, last.next, last.iterations, last.factorisations, last.evaluations, last.rejected, last.halved);
    each(last.order, last.contraction, last.left);
    list(s.report.events, [&](auto& met) { text(met.name), archive(met.time); });
    list(s.report.redundant, [&](auto& name) { text(name); });
    list(s.report.warnings, [&](auto& sentence) { text(sentence); });
  }

 private:
  template <class... X>
  void each(X&... x) {
    (archive(x), ...);
  }
  template <class List, class F>
  void list(List& of, F&& f) {
    archive.resize(of);
    for (auto& x : of) f(x);
  }
  template <class Text>
  void text(Text& of) {
    list(of, [&](auto& c) { archive(c); });
  }
  template <class V>
  void numbers(V& of) {
    archive.resize(of);
    for (Index i = 0; i < of.size(); ++i) archive(of[i]);
  }
};

struct SnapshotWriter {
  std::string bytes;
  template <class T>
  void operator()(T x) {
    std::conditional_t<std::is_floating_point_v<T>, double, std::int64_t> const wide(static_cast<decltype(wide)>(x));
    bytes.append(reinterpret_cast<char const*>(&wide), sizeof wide);
  }
  void operator()(char c) { (*this)(static_cast<unsigned char>(c)); }  // the signedness of char depends on the machine
  template <class List>
  void resize(List const& of) {
    (*this)(of.size());
  }
};

struct SnapshotReader {
  std::string_view bytes;
  std::string const& name;

  template <class T>
  void operator()(T& x) {
    std::conditional_t<std::is_floating_point_v<T>, double, std::int64_t> wide;
    if (bytes.size() < sizeof wide)
      throw IoError("checkpoint.damaged",
                    {"checkpoint \"", ErrorObject{name}, "\" is truncated within its content. Write it again."});
    std::memcpy(&wide, bytes.data(), sizeof wide);
    bytes.remove_prefix(sizeof wide);
    x = static_cast<T>(wide);
    if constexpr (!std::is_floating_point_v<T>)
      if (static_cast<std::int64_t>(x) != wide)
        throw IoError("checkpoint.damaged", {"checkpoint \"", ErrorObject{name}, "\" is inconsistent: ", wide,
                                             " exceeds the range of its number type. Write it again."});
  }
  void operator()(char& c) {
    unsigned char byte = 0;
    (*this)(byte);
    c = static_cast<char>(byte);
  }
  template <class List>
  void resize(List& of) {
    std::size_t count = 0;
    (*this)(count);
    if (count > bytes.size() / sizeof(double))
      throw IoError("checkpoint.damaged",
                    {"checkpoint \"", ErrorObject{name}, "\" is truncated within its content. Write it again."});
    of.resize(static_cast<decltype(of.size())>(count));
  }
};

/// Checks that the sizes in a snapshot agree with its model, and that no bytes follow the content (`left` is zero). A
/// checksum does not detect inconsistent sizes that another program has written.
/// \throws IoError otherwise.
template <class = void>
void require_consistent(RunSnapshot const& s, std::size_t left, std::string const& name) {
  std::string const inconsistent = "checkpoint \"" + name + "\" is inconsistent: ", remedy = ". Write it again.";
  if (left != 0)
    throw IoError("checkpoint.damaged", {ErrorObject{inconsistent}, left, " bytes follow its content", remedy});
  auto const require = [&](VecX const& x, Index size, std::string const& what) {
    if (x.size() != size)
      throw IoError("checkpoint.damaged",
                    {ErrorObject{inconsistent}, "it has ", x.size(), " ", what, ", but the model has ", size, remedy});
  };
  require(s.state.q, s.model.coordinates, "coordinates");
  require(s.state.v, s.model.velocities, "velocities");
  require(s.state.a, s.model.velocities, "accelerations");
  bool const estimates = s.state.lambda.size() > s.model.rows;
  require(s.state.lambda, s.model.rows + (estimates ? s.model.eliminated_equations : 0), "multipliers");
}

struct CheckpointHead {
  char kind[8];
  std::uint32_t order, version;
  std::uint64_t length;
};
inline constexpr CheckpointHead checkpoint_head{{'p', 'o', 'l', 'y', 'b', 'o', 'd', 'y'}, 0x01020304u, 6u, 0u};

}  // namespace detail

/// Writes a checkpoint to the file `name`. When complete, the new file replaces an existing file with this name.
/// Example:
///   if (run.report().steps % 1000 == 0) write_checkpoint("out/run.checkpoint", run.snapshot());
/// Another process continues the run with bitwise identical results:
///   auto run = resume(model, x, GeneralisedAlpha{}, options, read_checkpoint("out/run.checkpoint"));
/// \throws IoError if the file cannot be written.
template <class = void>
void write_checkpoint(std::filesystem::path const& name, RunSnapshot const& snapshot) {
  detail::SnapshotVisitor<detail::SnapshotWriter> content;
  content.walk(snapshot);
  detail::CheckpointHead head = detail::checkpoint_head;
  head.length = content.archive.bytes.size();
  std::string all(reinterpret_cast<char const*>(&head), sizeof head);
  all += content.archive.bytes;
  std::uint64_t const sum = checksum(all);
  all.append(reinterpret_cast<char const*>(&sum), sizeof sum);
  AtomicFile file(name);
  file.write(all);
  file.close();
}

/// Returns the snapshot in the checkpoint `file`.
/// \throws IoError for a file that cannot be read, is not a checkpoint, has another version or byte order, or is
/// truncated, damaged or inconsistent.
template <class = void>
RunSnapshot read_checkpoint(std::filesystem::path const& file) {
  std::string const name = file.string();
  std::optional<std::string> const content_of_file = detail::content_of(file);
  if (!content_of_file)
    throw IoError("file.open",
                  {"checkpoint \"", ErrorObject{name}, "\" cannot be read. Check its path and permissions."});
  std::string const& all = *content_of_file;
  detail::CheckpointHead const ours = detail::checkpoint_head;
  detail::CheckpointHead head = {};
  std::memcpy(&head, all.data(), std::min(all.size(), sizeof head));
  if (std::memcmp(head.kind, ours.kind, sizeof head.kind) != 0)
    throw IoError("checkpoint.format", {"file \"", ErrorObject{name},
                                        "\" is not a checkpoint of polybody. Use a file that write_checkpoint wrote."});
  if (all.size() < sizeof head)
    throw IoError("checkpoint.damaged", {"checkpoint \"", ErrorObject{name}, "\" is truncated within its first ",
                                         sizeof head, " bytes. Write it again."});
  if (head.order == 0x04030201u)
    throw IoError("checkpoint.format",
                  {"checkpoint \"", ErrorObject{name},
                   "\" was written on a machine with another byte order. Read it on a machine with that order."});
  if (head.version != ours.version)
    throw IoError("checkpoint.format",
                  {"checkpoint \"", ErrorObject{name}, "\" is of version ", ErrorValue{head.version},
                   ", but this program reads version ", ours.version, ". Read it with the program that wrote it."});
  std::uint64_t sum = 0;
  std::size_t const overhead = sizeof head + sizeof sum;
  if (all.size() < overhead || all.size() - overhead != head.length)
    throw IoError("checkpoint.damaged",
                  {"checkpoint \"", ErrorObject{name}, "\" is truncated or too long: it has ", all.size(),
                   " bytes instead of ", head.length + overhead, ". Write it again."});
  std::memcpy(&sum, all.data() + all.size() - sizeof sum, sizeof sum);
  std::string_view const summed = std::string_view(all).substr(0, all.size() - sizeof sum);
  if (checksum(summed) != sum)
    throw IoError("checkpoint.damaged", {"checkpoint \"", ErrorObject{name},
                                         "\" is damaged: its checksum differs from the checksum of its content. "
                                         "Write it again."});
  RunSnapshot snapshot;
  detail::SnapshotVisitor<detail::SnapshotReader> content{{summed.substr(sizeof head), name}};
  content.walk(snapshot);
  detail::require_consistent(snapshot, content.archive.bytes.size(), name);
  return snapshot;
}

}  // namespace polybody
