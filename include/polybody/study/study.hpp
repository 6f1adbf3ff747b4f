#pragma once
/// \file
/// Studies: evaluation of one function at many points, distributed over the threads of a machine. Each finished point
/// is recorded at once, so the next run continues a killed study. For the ranks of MPI see study/mpi.hpp.
///
/// Needs POSIX.

#include <thread>

#include <polybody/io/text_files.hpp>
#include <polybody/study/grid.hpp>
#include <polybody/study/limited_point.hpp>
#include <polybody/study/queue.hpp>

namespace polybody {

/// Record file and description of a study.
struct StudyFile {
  std::filesystem::path file;  ///< file of the record; created with its folder if it does not exist
  /// Description of everything that affects the outputs and is not a column: "chain of 8 links, 0.5 s". A record with a
  /// different description belongs to another study.
  std::string about = "";
};

namespace detail {

/// Outcome of f at a point. f returns the outputs as a number or a range of numbers. Errors of the library, except
/// StudyUsageError, are failures of the point; other exceptions are passed on.
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
      throw StudyUsageError("study.outputs", {"study: the point's function returns ", ErrorValue{outcome.values.size()},
                                              " numbers, but the study has ", outputs.size(), " outputs."});
    for (std::size_t j = 0; j < outputs.size(); ++j)
      if (!std::isfinite(outcome.values[j]))
        throw NonFiniteValue("output.not_finite", {"The output \"", ErrorObject{outputs[j].head}, "\" is not finite (",
                                                   ErrorValue{outcome.values[j]}, ")."});
    return outcome;
  } catch (StudyUsageError const&) {
    throw;
  } catch (Error const& error) {
    std::string why = error.what();
    std::ranges::replace_if(why, [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
    return {{}, why.empty() ? "an error without a message" : why};
  }
}

/// Outcome of f at a point. If the options have a time limit, f runs in a separate process.
template <class F>
Outcome outcome_of(F const& f, Point const& point, std::vector<StudyOutput> const& outputs,
                   StudyOptions const& options) {
  if (options.time_limit == 0.0) return outcome_of(f, point, outputs);
  return outcome_within(options.time_limit, outputs.size(), [&] { return outcome_of(f, point, outputs); });
}
/// Checks the options of a run.
/// \throws InvalidInput for fewer than one thread, and for a time limit that is negative or not finite.
template <class = void>
void check(StudyOptions const& options) {
  if (options.threads < 1)
    throw InvalidInput("workers.count",
                       {"study: at least one thread is needed, but ", ErrorValue{options.threads}, " are requested."});
  if (!(options.time_limit >= 0.0) || !std::isfinite(options.time_limit))
    throw InvalidInput("study.time_limit",
                       {"study: the time limit of a point must be positive, or zero for none, but is ",
                        ErrorValue{options.time_limit}, " s."});
}

}  // namespace detail

/// Study of a function at many points, recorded in a file:
///   Study study({.file = "out/chain.study", .about = "chain of 8 links"},
///               grid(axis("stiffness", "N/m", logarithmic(1e6, 1e10, 5)), axis("step", "s", {1e-3, 5e-4})),
///               outputs("error [m]", measured("cpu [s]")));
///   StudyResults const found = study.run([](Point const& p) { return std::array{…}; }, {.threads = 2});
/// A repeated run reads the finished points from the file and computes the others. The constructor does not access
/// the file.
class Study {
 public:
  /// Study with its record, points and outputs. Does not access the file.
  /// \throws InvalidInput for no output, and for heads of outputs that are empty, not printable, equal or used by
  /// columns, and for a description that is not printable.
  Study(StudyFile const& file, Points points, std::vector<StudyOutput> outputs)
      : file_(file), points_(std::move(points)), outputs_(std::move(outputs)) {
    std::vector<Column> heads;
    for (Column const& column : points_.columns()) heads.push_back({column.head()});
    for (StudyOutput const& output : outputs_) heads.push_back({output.head});
    if (outputs_.empty())
      throw InvalidInput("study.outputs", {"study \"", ErrorObject{file_.file.string()},
                                           "\": at least one output is needed, but the list is empty."});
    std::vector<double> const one_row(heads.size());
    Points(std::move(heads), one_row, "");  // checks the names
    if (std::ranges::any_of(file_.about, [](unsigned char c) { return c < ' ' || c == 127; }))
      throw InvalidInput("study.about", {"study \"", ErrorObject{file_.file.string()},
                                         "\": its description must be printable text without line breaks. Change "
                                         "`about`."});
  }

  /// Calls f(point) for each unfinished point, from several threads at once: f must not change shared data. The results
  /// of f, a number or a range of numbers, are the outputs. The point is recorded as failed if f throws an Error
  /// (except StudyUsageError), or if an output is not finite. With a time limit, the point also fails if it exceeds the
  /// limit or if its process crashes. The record contains the message. After an exception, the points that were
  /// finished before remain recorded.
  /// \throws IoError for a file that cannot be created or written, is open in another run, is damaged, or belongs to
  /// another study.
  /// \throws InvalidInput for fewer than one thread, and for a time limit that is negative or not finite.
  /// \throws any other exception of f; with a time limit, an Error with the message of that exception.
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
    } catch (std::system_error const&) {  // the system has no more threads; the existing ones suffice
    }
    work();
    for (std::thread& other : others) other.join();
    queue.rethrow();
    return results(queue.take(), points_.size() - queue.left(), record.torn());
  }

  /// Returns the results recorded so far, also while another process runs the study. The record is not changed.
  /// \throws IoError for a file that cannot be read, is damaged, or belongs to another study.
  template <class = void>  // compiled where it is used
  StudyResults recorded() const {
    auto const bytes = detail::content_of(file_.file);
    if (!bytes)
      throw IoError("file.open",
                    {"file \"", ErrorObject{file_.file.string()}, "\" cannot be read. Run the study first."});
    detail::RecordContent content = detail::record_content(kind(), *bytes);
    StudyResults so_far = results(std::move(content.outcomes), 0, content.torn);
    so_far.resumed = so_far.finished();
    return so_far;
  }

  Points const& points() const { return points_; }                      ///< points of the study
  std::vector<StudyOutput> const& outputs() const { return outputs_; }  ///< outputs at each point

  /// \name Access for other runners of a study (study/mpi.hpp)
  ///@{
  /// Identity of the study that the record must have.
  detail::RecordKind kind() const {
    return {file_.file.string(), detail::record_head(file_.about, points_, outputs_), points_.size(), outputs_.size()};
  }
  /// Label of the progress bar.
  std::string label() const { return file_.file.stem().string(); }
  /// Results of this study from `outcomes`; `resumed` and `torn` as in StudyResults.
  StudyResults results(std::vector<std::optional<Outcome>> outcomes, std::size_t resumed, bool torn) const {
    return {points_, outputs_, std::move(outcomes), resumed, torn};
  }
  ///@}

 private:
  StudyFile file_;
  Points points_;
  std::vector<StudyOutput> outputs_;
};

}  // namespace polybody
