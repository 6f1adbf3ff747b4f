#pragma once
/// \file
/// Examination of the text of a URDF file before it is parsed: encoding, nesting, and lines of links and joints.

#include <map>
#include <string>
#include <string_view>

#include <polybody/math/errors.hpp>
#include <polybody/math/types.hpp>

namespace polybody::detail {

/// Lines of the elements <link> and <joint> below the root of a URDF text. The constructor refuses texts that XML
/// parsers cannot handle safely.
class UrdfText {
 public:
  /// Examines `text` of `file`. \throws IoError for a text that is not UTF-8, contains a zero byte, has unbalanced
  /// elements, or more than 64 nested elements.
  template <class = void>  // compiled only if used
  UrdfText(std::string const& file, std::string_view text) : file_(file), text_(text) {
    require_utf8();
    while (at_ < text_.size()) {
      if (text_[at_] != '<')
        step(1);
      else if (at("<!--"))
        skip("<!--", "-->", "a comment");
      else if (at("<![CDATA["))
        skip("<![CDATA[", "]]>", "a CDATA section");
      else if (at("<?"))
        skip("<?", "?>", "a declaration");
      else if (at("<!"))
        skip("<!", ">", "a declaration");
      else
        read_tag();
    }
    if (depth_ > 0) fail("the file ends within an element");
    if (!root_) fail("the file has no element <robot>");
  }

  /// Line of the element `tag` with the name `name`, from 1; 0 if there is none.
  Index line_of(std::string const& tag, std::string const& name) const {
    auto const found = lines_.find({tag, name});
    return found == lines_.end() ? 0 : found->second;
  }

 private:
  [[noreturn, gnu::cold]] void fail(std::string const& what) const {
    throw IoError("file.content", {ErrorObject{file_}, ", line ", line_, ": ", what, "."});
  }
  bool at(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
  void step(std::size_t n) {
    for (; n > 0 && at_ < text_.size(); --n) line_ += text_[at_++] == '\n';
  }
  void skip(std::string_view first, std::string_view last, char const* what) {
    std::size_t const end = text_.find(last, at_ + first.size());
    if (end == text_.npos) fail(sentence_of({"the file ends within ", what}));
    step(end + last.size() - at_);
  }
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  /// Reads a tag, with the attribute `name` of children of the root.
  void read_tag() {
    Index const line = line_;
    bool const closes = text_.substr(at_ + 1, 1) == "/";
    step(closes ? 2 : 1);
    std::string const tag = word();
    if (tag.empty()) fail("an element begins without a name");
    std::string name;
    bool is_alone = false;
    while (at_ < text_.size() && text_[at_] != '>') {
      if (text_[at_] == '<') fail("the element <" + tag.substr(0, 40) + "> contains '<' before it ends");
      if (text_[at_] == '"' || text_[at_] == '\'') fail("a quoted value has no attribute");
      is_alone = text_[at_] == '/';
      if (is_blank(text_[at_]) || is_alone) {
        step(1);
        continue;
      }
      std::string const attribute = word();
      if (attribute.empty()) fail("an attribute of <" + tag.substr(0, 40) + "> has no name");
      std::string const value = read_value(attribute);
      if (attribute == "name") name = value;
    }
    if (at_ >= text_.size()) fail("the file ends within the element <" + tag.substr(0, 40) + ">");
    step(1);
    if (!closes && depth_ == 1) lines_.try_emplace({tag, name}, line);
    root_ = true;
    if (closes) {
      if (--depth_ < 0) fail("</" + tag.substr(0, 40) + "> ends an element that was not begun");
    } else if (!is_alone && ++depth_ > 64) {
      fail("elements are nested deeper than 64 levels");
    }
  }
  std::string word() {
    std::size_t const begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) &&
           std::string_view("=/><\"'").find(text_[at_]) == std::string_view::npos)
      step(1);
    return std::string(text_.substr(begin, at_ - begin));
  }
  std::string read_value(std::string const& attribute) {
    auto const blanks = [&] {
      while (at_ < text_.size() && is_blank(text_[at_])) step(1);
    };
    blanks();
    if (!at("=")) fail("the attribute " + attribute.substr(0, 40) + " has no value");
    step(1);
    blanks();
    if (!at("\"") && !at("'")) fail("the value of the attribute " + attribute.substr(0, 40) + " has no quotes");
    std::size_t const end = text_.find(text_[at_], at_ + 1);
    if (end == text_.npos) fail("the value of the attribute " + attribute.substr(0, 40) + " does not end");
    std::string const value(text_.substr(at_ + 1, end - at_ - 1));
    step(end + 1 - at_);
    return value;
  }

  /// Requires UTF-8 without zero bytes.
  void require_utf8() const {
    Index line = 1;
    for (std::size_t i = 0; i < text_.size();) {
      auto const byte = static_cast<unsigned char>(text_[i]);
      std::size_t const more = byte < 0x80 ? 0 : byte >> 5 == 6 ? 1 : byte >> 4 == 14 ? 2 : byte >> 3 == 30 ? 3 : 9;
      bool valid = byte != 0 && more < 9 && i + more < text_.size();
      for (std::size_t k = 1; valid && k <= more; ++k) valid = (static_cast<unsigned char>(text_[i + k]) >> 6) == 2;
      if (!valid)
        throw IoError("file.content", {ErrorObject{file_}, ", line ", line, ": the byte ", int(byte),
                                       " does not belong to a text in UTF-8."});
      line += byte == '\n';
      i += more + 1;
    }
  }

  std::string const& file_;
  std::string_view text_;
  std::size_t at_ = 0;
  Index line_ = 1;
  int depth_ = 0;
  bool root_ = false;
  std::map<std::pair<std::string, std::string>, Index> lines_ = {};
};

}  // namespace polybody::detail
