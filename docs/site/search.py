#!/usr/bin/env python3
"""Makes find.html, the page that searches the text of the site by lunr, and its list of pages.

  docs/site/search.py FOLDER    FOLDER: html pages of the site

The list contains title, address and the first words of each page, without lists of members and of files. The browser builds the
index, so the search needs neither a server nor a network.

"""

import html
import json
import re
import sys
from pathlib import Path

SKIPPED = re.compile(r"-members\.html$|_source\.html$|^(?:dir_|functions|namespacemembers|globals|files|classes|annotated|namespaces|concepts)|^find\.html$")
LONGEST = 8000  # letters of a page in the list
PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>polybody: search</title>
<link href="doxygen.css" rel="stylesheet"><link href="doxygen-awesome.css" rel="stylesheet"><link href="style.css" rel="stylesheet">
<script src="lunr.min.js"></script><script src="find_pages.js"></script></head>
<body class="find-page"><h1><a href="index.html">polybody</a>: search</h1>
<form action="find.html"><input name="q" type="search" aria-label="Search the text" autofocus> <button>Search</button></form>
<p id="count"></p><ol id="hits"></ol>
<script>
const words = new URLSearchParams(location.search).get("q") || "";
document.querySelector("input").value = words;
if (words.trim()) {
  const index = lunr(function () {
    this.ref("address"); this.field("title", {boost: 10}); this.field("text");
    // pages of text come before classes, and classes before headers
    for (const page of PAGES) this.add(page, {boost: /^(guide|howto|items|lessons|theory|page)_/.test(page.address) ? 6 : / File Reference$/.test(page.title) ? 0.5 : 1});
  });
  const plain = words.replace(/[:~^*+-]/g, " ").trim();
  let found = index.search(plain);
  if (!found.length) found = index.search(plain.split(/\\s+/).map(w => w + "*").join(" "));
  const pages = new Map(PAGES.map(page => [page.address, page]));
  document.getElementById("count").textContent = found.length + " pages";
  for (const {ref} of found.slice(0, 60)) {
    const page = pages.get(ref), item = document.createElement("li"), link = document.createElement("a");
    const at = Math.max(0, page.text.toLowerCase().indexOf(plain.toLowerCase().split(" ")[0]) - 60);
    link.href = ref; link.textContent = page.title; item.className = "hit";
    item.append(link, document.createElement("br"), (at ? "… " : "") + page.text.slice(at, at + 160) + " …");
    document.getElementById("hits").append(item);
  }
}
</script></body></html>
"""


def plain(text):
    text = re.sub(r"<(script|style)\b.*?</\1>", " ", text, flags=re.S)
    return re.sub(r"\s+", " ", html.unescape(re.sub(r"<[^>]*>", " ", text))).strip()


def main(folder):
    pages = []
    for file in sorted(folder.glob("*.html")):
        if SKIPPED.search(file.name):
            continue
        content = file.read_text(encoding="utf-8")
        title = re.search(r"<title>(?:polybody: )?(.*?)</title>", content, re.S)
        start = content.find('<div class="contents">')
        if title and start > 0:
            pages.append({"address": file.name, "title": plain(title[1]).removeprefix("polybody::"), "text": plain(content[start:])[:LONGEST]})
    (folder / "find_pages.js").write_text("const PAGES = " + json.dumps(pages, ensure_ascii=False) + ";\n", encoding="utf-8")
    (folder / "find.html").write_text(PAGE, encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
