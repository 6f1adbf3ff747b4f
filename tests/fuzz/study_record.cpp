// Records of studies. An accepted record has the study's own outputs or an error message at each of its points. It is
// written line by line and read again with the same result. A torn line can occur only at the end. The input is read
// unchanged, as lines after the head, and as texts of lines with correct checksums.
#include <polybody/study/queue.hpp>

#include "fuzz/target.hpp"

namespace polybody::fuzz {

detail::RecordKind const& kind() {
  static detail::RecordKind const one{
      "fuzz.study",
      {"polybody study 1", "about: ", "column: x", "points: 5, list, checksum 0", "output: y", "output: z"},
      5,
      2};
  return one;
}

std::string lines_of(detail::RecordContent const& content) {
  detail::RecordChain chain;
  std::string text = detail::head_text(kind(), chain);
  for (std::size_t i = 0; i < content.outcomes.size(); ++i)
    if (content.outcomes[i]) text += chain.line(detail::record_text(i, *content.outcomes[i]));
  return text;
}

void check(std::string_view bytes) {
  auto const content = accepted([&] { return detail::record_content(kind(), bytes); },
                                [](std::string const& message) { return has(message, "file \"fuzz.study\", line "); });
  if (!content) return;
  require(content->outcomes.size() == 5, "there is a place for each point");
  require(content->whole <= bytes.size(), "the whole part is not longer than all");
  require(content->torn == (content->whole < bytes.size()), "what is torn is at the end");
  for (auto const& outcome : content->outcomes) {
    if (!outcome) continue;
    require(outcome->failed() ? outcome->values.empty() : outcome->values.size() == 2,
            "an outcome has all numbers or none");
    for (double const x : outcome->values) require(std::isfinite(x), "numbers are finite");
  }
  std::string const written = lines_of(*content);
  detail::RecordContent const again = detail::record_content(kind(), written);
  require(lines_of(again) == written && !again.torn, "a record that is written is read as the same");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody;
  std::string_view const input = fuzz::text_of(data, size);
  detail::RecordChain chain;
  std::string const head = detail::head_text(fuzz::kind(), chain);
  fuzz::check(input);
  fuzz::check(head.substr(0, input.size() % (head.size() + 1)));
  fuzz::check(head + std::string(input));
  std::string lines = head;
  std::string_view rest = input;
  for (std::size_t end; (end = rest.find('\n')) != rest.npos; rest.remove_prefix(end + 1))
    lines += chain.line(std::string(rest.substr(0, end)));
  fuzz::check(lines + std::string(rest));
  return 0;
}
