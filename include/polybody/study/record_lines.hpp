#pragma once
/// \file
/// Text of a study's record: each line ends with a checksum of itself and of all preceding lines.
///
///     polybody study 1	#5c9d6e3a70b1f284
///     description, columns, points and outputs of the study	#…
///     17: 0.00125 3.5	#…                                   point 17 and its outputs, in digits that read back exactly
///     18 failed: Newton's method …	#…

#include <charconv>

#include <polybody/io/text_files.hpp>
#include <polybody/math/checksum.hpp>
#include <polybody/study/outcome.hpp>

namespace polybody::detail {

template <class = void>  // compiled where it is used
std::string sixteen_digits(std::uint64_t x) {
  std::string text(16, '0');
  for (std::size_t i = 16; i-- > 0; x >>= 4) text[i] = "0123456789abcdef"[x & 15u];
  return text;
}

/// Writer and checker of lines. Each checksum depends on the previous one, so a missing line is detected.
struct RecordChain {
  std::string link{};  ///< checksum of the last line

  std::string line(std::string const& text) {
    link = sixteen_digits(checksum(link + text));
    return text + "\t#" + link + '\n';
  }
  /// Returns the text of a line without its checksum, or nothing if the checksum does not continue the chain.
  std::optional<std::string> text(std::string_view line) {
    std::size_t const tail = 2 + 16;
    if (line.size() < tail) return std::nullopt;
    std::string const body(line.substr(0, line.size() - tail));
    RecordChain after{link};
    std::string const whole = after.line(body);
    if (std::string_view(whole).substr(0, whole.size() - 1) != line) return std::nullopt;
    link = after.link;
    return body;
  }
};

/// Lines that identify a study: description, columns, points and outputs.
template <class = void>
std::vector<std::string> record_head(std::string const& about, Points const& points,
                                     std::vector<StudyOutput> const& outputs) {
  std::vector<std::string> lines{"polybody study 1", "about: " + about};
  for (Column const& column : points.columns()) {
    std::string text = "column: " + column.head();
    for (std::size_t k = 0; k < column.choices.size(); ++k) text += (k ? " | " : " = ") + column.choices[k];
    lines.push_back(std::move(text));
  }
  std::string values;
  for (double const x : points.values()) values += all_digits(x) + ' ';
  lines.push_back("points: " + std::to_string(points.size()) + ", " + points.origin() + ", checksum " +
                  sixteen_digits(checksum(values)));
  for (StudyOutput const& output : outputs)
    lines.push_back((output.measured ? "measured: " : "output: ") + output.head);
  return lines;
}

/// Line of an outcome: "17: 0.00125 3.5" or "18 failed: why"
template <class = void>
std::string record_text(std::size_t point, Outcome const& outcome) {
  std::string text = std::to_string(point) + (outcome.failed() ? " failed: " + outcome.failure : ":");
  for (double const x : outcome.values) append_digits(text += ' ', x);
  return text;
}

/// Outcome of a line written by `record_text`. Returns nothing if the line has neither form, if the point is not below
/// `points`, or if the count of numbers is not `outputs`.
template <class = void>
std::optional<std::pair<std::size_t, Outcome>> outcome_in(std::string_view text, std::size_t points,
                                                          std::size_t outputs) {
  std::size_t point = 0;
  char const *at = text.data(), *const end = at + text.size();
  auto const read = std::from_chars(at, end, point);
  if (read.ec != std::errc{} || point >= points) return std::nullopt;
  text.remove_prefix(std::size_t(read.ptr - at));
  constexpr std::string_view failed = " failed: ";
  if (text.starts_with(failed) && text.size() > failed.size())
    return std::pair{point, Outcome{{}, std::string(text.substr(failed.size()))}};
  if (!text.starts_with(':')) return std::nullopt;
  Outcome outcome;
  for (at = read.ptr + 1; at != end && *at == ' ';) {
    double x = 0.0;
    auto const number = std::from_chars(at + 1, end, x);
    if (number.ec != std::errc{} || !std::isfinite(x)) return std::nullopt;
    outcome.values.push_back(x);
    at = number.ptr;
  }
  if (at != end || outcome.values.size() != outputs) return std::nullopt;
  return std::pair{point, outcome};
}

}  // namespace polybody::detail
