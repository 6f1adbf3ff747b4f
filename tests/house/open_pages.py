#!/usr/bin/env python3
"""Opens the pages of docs, classes with formulas and groups of the site in headless Chromium, 1280 and 390 pixels wide.

  tests/house/open_pages.py SITE CHROMIUM    SITE is the folder of the HTML pages

Requires that each formula is drawn without an error, that the title fits, that each picture exists, and that text and pictures are not
wider than the window. The same holds for lists of members at the larger width; at the smaller one they extend to the margins.
"""

import html
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

WIDTHS = (1280, 390)
KINDS = ("guide", "howto", "items", "lessons", "page", "theory", "validated")  # page: all other folders of docs
HARNESS = """<!DOCTYPE html><meta charset="utf-8"><pre id="found"></pre><script>
const pages = %s, widths = %s;
async function open(url, width) {
  const frame = document.createElement("iframe");
  frame.style.cssText = `width:${width}px;height:900px;border:0`;
  const loaded = new Promise(done => { frame.onload = done; setTimeout(done, 20000); });
  frame.src = url;
  document.body.append(frame);
  await loaded;
  await new Promise(done => setTimeout(done, 300));
  const faults = [], page = frame.contentDocument, name = url.split("/").pop() + " at " + width + " px: ";
  if (!page || !page.querySelector(".title")) faults.push(name + "no title");
  else {
    const formulas = [...page.querySelectorAll(".tex")];
    const undrawn = formulas.filter(e => !e.querySelector(".katex-html") || e.querySelector('.katex-error, [mathcolor="#cc0000"]'));
    if (undrawn.length) faults.push(name + undrawn.length + " formulas are not drawn: " + undrawn[0].textContent.slice(0, 60));
    const cut = formulas.filter(e => e.tagName === "DIV" && e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).overflowX === "visible");
    if (cut.length) faults.push(name + "a formula is cut: " + cut[0].textContent.slice(0, 60));
    const title = page.querySelector(".title"), box = page.querySelector("#doc-content") || page.body;
    if (title.scrollWidth > title.clientWidth + 1) faults.push(name + "the title is cut");
    for (const e of page.querySelectorAll(".contents > p, .contents > div.textblock > p, .contents > div.textblock > ul" + (width > 800 ? ", .memberdecls td" : "")))
      if (e.getBoundingClientRect().right > box.getBoundingClientRect().left + box.clientWidth + 1) {
        faults.push(name + "the text is wider than the window: " + e.textContent.slice(0, 60));
        break;
      }
    for (const e of page.querySelectorAll(".contents img")) {
      if (e.complete && !e.naturalWidth) faults.push(name + "a picture is missing: " + e.getAttribute("src"));
      else if (e.scrollWidth > box.clientWidth + 1) faults.push(name + "a picture is wider than the window: " + e.getAttribute("src"));
    }
  }
  frame.remove();
  return faults;
}
(async () => {
  const found = [];
  for (const width of widths) for (const url of pages) found.push(...await open(url, width));
  document.getElementById("found").textContent = "opened " + pages.length + "\\n" + found.join("\\n");
})();
</script>"""


def main():
    site = Path(sys.argv[1]).resolve()
    browser = sys.argv[2]
    pages = [p for kind in KINDS for p in sorted(site.glob(f"{kind}_*.html"))]
    pages += [p for p in sorted(site.glob("*polybody_1_1*.html")) if 'class="tex"' in p.read_text(encoding="utf-8")]
    pages += sorted(site.glob("group__floor__*.html"))
    with tempfile.TemporaryDirectory() as folder:
        harness = Path(folder) / "open.html"
        harness.write_text(HARNESS % (json.dumps([p.as_uri() for p in pages]), json.dumps(WIDTHS)), encoding="utf-8")
        ran = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files",
                              f"--user-data-dir={folder}/profile", "--virtual-time-budget=2000000", "--dump-dom", harness.as_uri()],
                             capture_output=True, text=True, timeout=600)
    found = re.search(r'<pre id="found">(.*?)</pre>', ran.stdout, re.S)
    lines = html.unescape(found[1]).strip().split("\n") if found else [""]
    if lines[0] != f"opened {len(pages)}" or not pages:
        sys.exit(f"The browser did not open the {len(pages)} pages: {ran.stderr[-300:]}")
    print(f"{len(pages)} pages at {WIDTHS[0]} and {WIDTHS[1]} pixels")
    if lines[1:] and lines[1]:
        sys.exit("\n".join(lines[1:]))


if __name__ == "__main__":
    main()
