#pragma once
/// \file
/// Reader of a study's record, which distinguishes complete lines, the incomplete line of a killed run, and invalid
/// content.
///
/// Not in polybody.hpp: it belongs to study/study.hpp.

#include <polybody/study/record_lines.hpp>

namespace polybody::detail {

/// Identity of the study to which a record must belong.
struct RecordKind {
  std::string file;               ///< name of the file, for messages
  std::vector<std::string> head;  ///< `record_head`
  std::size_t points = 0, outputs = 0;
};

/// Content of a record.
struct RecordContent {
  std::vector<std::optional<Outcome>> outcomes{};  ///< outcomes of all points
  std::size_t whole = 0;                           ///< size up to the end of the last complete line [bytes]; 0: no head
  bool torn = false;                               ///< true: an incomplete line follows
  RecordChain chain{};                             ///< state of the chain after the last complete line
};

[[noreturn, gnu::cold]] inline void refuse_record(RecordKind const& kind, std::size_t line, std::string const& why) {
  throw IoError("file.content", {"file \"", ErrorObject{kind.file}, "\", line ", line, ": ", why});
}

/// Text of the head of a record, with checksums.
template <class = void>
std::string head_text(RecordKind const& kind, RecordChain& chain) {
  std::string text;
  for (std::string const& line : kind.head) text += chain.line(line);
  return text;
}

template <class = void>
void require_head_line(RecordKind const& kind, std::size_t line, std::string const& text) {
  std::string const& ours = kind.head[line - 1];
  if (text == ours) return;
  if (line == 1) refuse_record(kind, line, "the line is \"" + text + "\", but this program expects \"" + ours + "\"");
  refuse_record(kind, line,
                "the record belongs to another study: it has \"" + text + "\", but this study has \"" + ours +
                    "\". Use another file for this study, or remove the old file");
}

/// Stores the outcome of a line. A failed point may occur again if a later run has computed it again.
template <class = void>
void take_outcome(RecordKind const& kind, std::size_t line, std::string const& text, RecordContent& content) {
  auto found = outcome_in(text, kind.points, kind.outputs);
  if (!found) refuse_record(kind, line, "\"" + text + "\" is not an outcome of this study");
  std::optional<Outcome>& place = content.outcomes[found->first];
  if (place && !place->failed()) refuse_record(kind, line, "point " + std::to_string(found->first) + " occurs twice");
  place = std::move(found->second);
}

/// Reads the `bytes` of a record. The last line, or the head, may be incomplete after a killed run.
/// \throws IoError with file and line for damage, another study, or a file that is not a record.
template <class = void>
RecordContent record_content(RecordKind const& kind, std::string_view bytes) {
  RecordContent content{.outcomes = std::vector<std::optional<Outcome>>(kind.points)};
  RecordChain at_start;
  std::string const head = head_text(kind, at_start);
  if (bytes.size() < head.size() && std::string_view(head).starts_with(bytes)) {
    content.torn = !bytes.empty();
    return content;
  }
  std::size_t line = 0;
  for (std::size_t end; (end = bytes.find('\n', content.whole)) != bytes.npos; content.whole = end + 1) {
    ++line;
    auto const text = content.chain.text(bytes.substr(content.whole, end - content.whole));
    if (!text && line == 1)
      refuse_record(kind, line, "the file is not a record of a study, or its first line is damaged");
    if (!text)
      refuse_record(
          kind, line,
          "the line is damaged, or a previous line is missing: the checksum is wrong. Remove the file to start "
          "the study again, or restore an undamaged copy");
    if (line <= kind.head.size())
      require_head_line(kind, line, *text);
    else
      take_outcome(kind, line, *text, content);
  }
  if (line < kind.head.size())
    refuse_record(kind, line + 1, "the file is not a record of this study: its head is incomplete");
  content.torn = content.whole < bytes.size();
  return content;
}

}  // namespace polybody::detail
