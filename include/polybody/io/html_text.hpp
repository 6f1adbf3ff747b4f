#pragma once
/// \file
/// Text of HTML pages: escaped text, addresses of files, and numbers for readers.

#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include <polybody/math/compiler.hpp>

namespace polybody::detail {

/// Escapes a text for the content of an HTML element and for an attribute in double or single quotes.
template <class = void>  // compiled where it is used
std::string html_escaped(std::string_view text) {
  std::string out;
  for (char const c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// Address of a file relative to the folder of a page, percent-encoded [RFC 3986, §2.1]. The address is absolute if no
/// relative path exists.
template <class = void>
std::string relative_address(std::filesystem::path const& file, std::filesystem::path const& page) {
  namespace fs = std::filesystem;
  std::error_code reason;
  fs::path const folder = fs::absolute(page, reason).parent_path();
  fs::path const near = fs::proximate(file, folder, reason);
  std::u8string const path = (reason ? file : near).generic_u8string();
  std::string out = (reason ? file : near).is_absolute() ? "file://" : "";
  for (char8_t const letter : path) {
    char const c = static_cast<char>(letter);
    bool const plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::string_view("-._~/").find(c) != std::string_view::npos;
    if (plain)
      out += c;
    else
      out += {'%', "0123456789ABCDEF"[letter >> 4], "0123456789ABCDEF"[letter & 15]};
  }
  return out;
}

inline constexpr std::string_view no_break = "\u00A0";  ///< space without a line break

/// Integer in superscript digits: "⁻³" for −3.
template <class = void>
std::string superscript(int n) {
  static constexpr std::string_view digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = n < 0 ? "⁻" : "";
  for (char const c : std::to_string(n < 0 ? -n : n)) out += digits[c - '0'];
  return out;
}

/// Number with `places` digits after the decimal point and a minus sign "−".
template <class = void>
std::string fixed_text(double x, int places) {
  char text[400];
  auto const end = std::to_chars(text, text + sizeof text, std::abs(x), std::chars_format::fixed, places).ptr;
  std::string out(text, end);
  bool const negative = x < 0.0 && out.find_first_not_of("0.") != out.npos;
  return negative ? "−" + out : out;
}

/// Number with at least `digits` significant digits: "0.00410", "350", "1.20 × 10⁻⁷"; "–" if x is not finite. The text
/// has no line break.
template <class = void>
std::string readable(double x, int digits = 3) {
  if (!std::isfinite(x)) return "–";
  if (x == 0.0) return "0";
  char text[64];
  std::string const full(
      text, std::to_chars(text, text + sizeof text, std::abs(x), std::chars_format::scientific, digits - 1).ptr);
  std::size_t const at = full.find('e');
  int const exponent = std::stoi(full.substr(at + 1));  // after rounding
  if (exponent >= -4 && exponent < 6) return fixed_text(x, exponent >= digits ? 0 : digits - 1 - exponent);
  return (x < 0.0 ? "−" : "") + full.substr(0, at) + "\u00A0×\u00A010" + superscript(exponent);
}

/// Number without trailing zeros: "0.0025", "20", "10⁻⁶", "2.5 × 10⁻⁵".
template <class = void>
std::string short_text(double x, int digits = 6) {
  constexpr std::string_view times = "\u00A0×\u00A0";
  std::string text = readable(x, digits), tail;
  if (std::size_t const at = text.find(times); at != text.npos) {
    tail = text.substr(at);
    text.resize(at);
  }
  if (text.find('.') != text.npos) text.resize(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "1" && !tail.empty() ? tail.substr(times.size()) : text + tail;
}

}  // namespace polybody::detail
