// Results of other programs for the atlas. An accepted result has a name, a version, a known problem and a setting, and
// either an error or a history. The results are written and read again with the same values.
#include "atlas/external_results.hpp"

#include "fuzz/target.hpp"

namespace polybody::fuzz {

std::vector<std::string> const problems{"robot_arm", "chain"};

std::string quoted(std::string const& text) {
  std::string out = "\"";
  for (char const c : text) out.append(c == '"' ? 2u : 1u, c);
  return out + '"';
}
std::string digits(std::optional<double> const& x) {
  if (!x) return "";
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", *x);
  return text;
}
std::string line_of(atlas::ExternalResult const& r) {
  return quoted(r.name) + ',' + quoted(r.version) + ',' + quoted(r.problem) + ',' + quoted(r.setting) + ',' +
         quoted(r.model) + ',' + digits(r.error) + ',' + quoted(r.history) + ',' + digits(r.time) + ',' +
         quoted(r.machine) + '\n';
}

void check(std::vector<atlas::ExternalResult> const& all) {
  std::string again = "name,version,problem,setting,model,error,history,time,machine\n", lines;
  for (atlas::ExternalResult const& r : all) {
    for (std::string const& text : {r.name.value, r.version.value, r.setting.value})
      require(!text.empty(), "required texts are not empty");
    require(r.problem.value == problems[0] || r.problem.value == problems[1], "the problem is known");
    require(r.error.has_value() == r.history.empty(), "a result has either an error or a history");
    require(!r.error || (std::isfinite(*r.error) && *r.error >= 0.0), "errors are finite and not negative");
    require(!r.time || (std::isfinite(*r.time) && *r.time > 0.0 && !r.machine.empty()), "a time has a machine");
    require(r.history.empty() || !r.model.empty(), "a history has a model");
    lines += line_of(r);
  }
  std::string second;
  for (atlas::ExternalResult const& r : atlas::read_external(folder().put("again.csv", again + lines), problems))
    second += line_of(r);
  require(second == lines, "results that are written are read as the same");
}

}  // namespace polybody::fuzz

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
  using namespace polybody::fuzz;
  std::string const file = folder().put("external.csv", text_of(data, size));
  auto const all = accepted([&] { return atlas::read_external(file, problems); },
                            [&](std::string const& message) { return has(message, "file \"" + file + "\", line "); });
  if (all) check(*all);
  return 0;
}
