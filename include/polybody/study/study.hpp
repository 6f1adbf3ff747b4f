#pragma once
/// \file
/// Studies: one function at many points, over the threads of a machine. Each finished point is recorded at once, so a
/// study that was killed goes on where it was. Over the ranks of MPI: study/mpi.hpp.
///
/// Not in polybody.hpp: of use to studies only. Needs POSIX.

#include <thread>

#include <polybody/io/file_content.hpp>
#include <polybody/study/grid.hpp>
#include <polybody/study/limited_point.hpp>
#include <polybody/study/queue.hpp>

namespace polybody {

/// Where a study is recorded, and what its function computes.
struct StudyFile {
  std::filesystem::path file;  ///< made with its folder, or gone on with
  /// In words, with all that the outputs depend on and that is no column: "chain of 8 links, 0.5 s". A record with
  /// other words is of another study.
  std::string about = "";
};

namespace detail {

/// What f gives at a point: a number, or a range of them, for the outputs. Errors of the library are failures of the
/// point; all else is passed on.
template <class F>
Outcome outcome_of(F const& f, Point const& point, std::vector<StudyOutput> const& outputs) {
  try {
    Outcome outcome;
    auto const found = f(point);
    if constexpr (std::convertible_to<decltype(found), double>)
      outcome.values.push_back(found);
    else
      for (double const x : found) outcome.values.push_back(x);
    if (outcome.values.size() != outputs.size())
      throw StudyMisuse{"study: the point's function gives ", outcome.values.size(), " numbers for ", outputs.size(),
                        " outputs."};
    for (std::size_t j = 0; j < outputs.size(); ++j)
      if (!std::isfinite(outcome.values[j]))
        throw NonFinite{"The output '", outputs[j].head, "' is not finite (", outcome.values[j], ")."};
    return outcome;
  } catch (StudyMisuse const&) {
    throw;
  } catch (Error const& error) {
    std::string why = error.what();
    std::ranges::replace_if(why, [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
    return {{}, why.empty() ? "without a word" : why};
  }
}

/// The same within the time limit of the options, if they have one.
template <class F>
Outcome outcome_of(F const& f, Point const& point, std::vector<StudyOutput> const& outputs,
                   StudyOptions const& options) {
  if (options.time_limit == 0.0) return outcome_of(f, point, outputs);
  return outcome_within(options.time_limit, outputs.size(), [&] { return outcome_of(f, point, outputs); });
}
/// \throws InvalidInput for less than one thread and a time limit that is negative or not finite.
template <class = void>
void check(StudyOptions const& options) {
  if (options.threads < 1)
    throw InvalidInput{"study: at least one thread is needed, but ", options.threads, " are asked for."};
  if (!(options.time_limit >= 0.0) || !std::isfinite(options.time_limit))
    throw InvalidInput{"study: the time limit of a point must be positive, or zero for none, but is ",
                       options.time_limit, " s."};
}

}  // namespace detail

/// A study:
///   Study study({.file = "out/chain.study", .about = "chain of 8 links"},
///               grid(axis("stiffness", "N/m", logarithmic(1e6, 1e10, 5)), axis("step", "s", {1e-3, 5e-4})),
///               outputs("error [m]", measured("cpu [s]")));
///   StudyResults const found = study.run([](Point const& p) { return std::array{…}; }, {.threads = 2});
/// Run again, it takes what the file holds and does the rest. Nothing of the file is touched before it runs.
class Study {
 public:
  /// \throws InvalidInput for no output, and heads of outputs that are empty, not printable, alike or those of columns.
  Study(StudyFile const& file, Points points, std::vector<StudyOutput> outputs)
      : file_(file), points_(std::move(points)), outputs_(std::move(outputs)) {
    std::vector<Column> heads;
    for (Column const& column : points_.columns()) heads.push_back({column.head()});
    for (StudyOutput const& output : outputs_) heads.push_back({output.head});
    if (outputs_.empty()) throw InvalidInput{"study '", file_.file.string(), "': it needs one output at least."};
    std::vector<double> const one_row(heads.size());
    Points(std::move(heads), one_row, "");  // checks names
    if (std::ranges::any_of(file_.about, [](unsigned char c) { return c < ' ' || c == 127; }))
      throw InvalidInput{"study '", file_.file.string(), "': what it is about must be words on one line."};
  }

  /// Calls f(point) for each point that is not finished, by several threads at once: f must not change what it shares.
  /// What f gives, a number or a range of numbers, are the outputs; where f throws an Error, or an output is not
  /// finite, the point is recorded as failed with that sentence. So is a point that exceeds the time limit of the
  /// options.
  /// \throws IoError for a file that cannot be made or written, that another run has open, that is damaged or of
  /// another study; InvalidInput for less than one thread and a negative time limit; what else f throws,
  /// under a time limit as an Error with its sentence. What is finished by then is recorded.
  template <class F>
    requires std::is_invocable_v<F const&, Point const&>
  StudyResults run(F const& f, StudyOptions const& options = {}) const {
    detail::check(options);
    detail::StudyRecord record(kind());
    detail::StudyQueue queue(record, options, label());
    auto const work = [&] {
      queue.work([&](std::size_t i) { return detail::outcome_of(f, points_[i], outputs_, options); });
    };
    std::vector<std::thread> others;
    std::size_t const useful = std::min(std::size_t(options.threads), queue.left());
    others.reserve(useful);
    try {
      while (others.size() + 1 < useful) others.emplace_back(work);
    } catch (std::system_error const&) {  // the system has no more; those that there are do
    }
    work();
    for (std::thread& other : others) other.join();
    queue.rethrow();
    return results(queue.take(), points_.size() - queue.left(), record.torn());
  }

  /// What is recorded so far, also while another process runs the study; nothing is changed. \throws IoError as `run`.
  template <class = void>  // compiled where it is used
  StudyResults recorded() const {
    auto const bytes = detail::content_of(file_.file);
    if (!bytes) throw IoError{"file '", file_.file.string(), "' cannot be read"};
    detail::RecordContent content = detail::record_content(kind(), *bytes);
    StudyResults so_far = results(std::move(content.outcomes), 0, content.torn);
    so_far.taken_over = so_far.finished();
    return so_far;
  }

  Points const& points() const { return points_; }                      ///< at which it runs
  std::vector<StudyOutput> const& outputs() const { return outputs_; }  ///< what it finds at each

  /// \name For those who run studies in other ways (study/mpi.hpp)
  ///@{
  /// Which study the record must be of.
  detail::RecordKind kind() const {
    return {file_.file.string(), detail::record_head(file_.about, points_, outputs_), points_.size(), outputs_.size()};
  }
  /// What the bar of progress calls it.
  std::string label() const { return file_.file.stem().string(); }
  /// Outcomes with the study that they are of; `taken_over`, `torn` as in StudyResults.
  StudyResults results(std::vector<std::optional<Outcome>> outcomes, std::size_t taken_over, bool torn) const {
    return {points_, outputs_, std::move(outcomes), taken_over, torn};
  }
  ///@}

 private:
  StudyFile file_;
  Points points_;
  std::vector<StudyOutput> outputs_;
};

}  // namespace polybody
