"""Sections of the gallery: the examples with their pictures and films, the small mechanisms and the atlas.

  docs/site/gallery.py LABEL... < LINES    LABEL: labels of the pages of the atlas

docs/site/build writes a line for each example, and for each of its pictures and films:

  stage    NAME   DESCRIPTION   COMMAND
  picture  FILE   SENTENCE

Fields are separated by tabs. The mechanisms are those of docs/mechanisms.md, which is read here.

"""
import html
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
FIGURE = '<figure><a href="{0}"><img loading="lazy" src="{0}" alt="{1}"/></a><figcaption>{1}{2}</figcaption></figure>'
FILM = '<figure class="film"><a href="{0}">&#9654; Film</a>. {1}</figure>'
MECHANISM = re.compile(r"^## (.*)\n\n(.*)\nKnown number: (.*)\n\n!\[.*\]\(.*/(\w+\.png)\)", re.M)

LINK = re.compile(r"\[([^\]]*)\]\([^)]*\)")


def show(pictures):
    """The pictures and films of a section: file, sentence and, for some, the command that writes the picture."""
    print('\\htmlonly\n<div class="gallery">')
    for file, sentence, *command in pictures:
        code = "".join(f"<br/><code>{html.escape(line)}</code>" for line in command)
        print((FILM if file.endswith(".html") else FIGURE).format(html.escape(file), html.escape(sentence), code))
    print("</div>\n\\endhtmlonly\n")


def examples(lines):
    stages = []
    for line in lines:
        kind, *fields = line.split("\t")
        if kind == "stage":
            stages.append((*fields, []))
        else:
            stages[-1][-1].append(fields)
    if not any(pictures for *_, pictures in stages):
        print("\nThis site was built before any example ran. Run `examples/run`, then `docs/site/build` again.")
    print()
    for name, shows, command, pictures in stages:
        print(f"## {name.replace('_', ' ').capitalize().replace(' fe', ' finite elements')}\n\n{shows}\n")
        print(f"```sh\nexamples/run {name}   # builds it, and runs: {command}\n```\n")
        if pictures:
            show(pictures)


def mechanisms():
    page = (ROOT / "docs/mechanisms.md").read_text(encoding="utf-8")
    print('## Mechanisms\n\nThe page \\ref page_mechanisms "Small mechanisms" has their programs.\n')
    print("```sh\ncmake --preset release && cmake --build build/release --target mechanisms   # builds all of them\n```\n")
    show([(file, f"{name}. {sentence} Known number: {known}", f"build/release/examples/mechanism_{Path(file).stem}")
          for name, sentence, known, file in MECHANISM.findall(page)])


def atlas(reports):
    print("## Atlas\n\nEach page compares the formulations at equal error. `atlas` writes the reports with curves.\n")
    for name, *report in reports:
        title, _, sentence, *_ = LINK.sub(r"\1", (ROOT / f"docs/atlas/{name}.md").read_text(encoding="utf-8")).split("\n")
        print(f'- \\ref page_{name} "{title.removeprefix("# ")}": {sentence}', *(f'<a href="{file}">Report with curves</a>.' for file in report))


if __name__ == "__main__":
    examples(sys.stdin.read().splitlines())
    mechanisms()
    atlas([argument.split("=") for argument in sys.argv[1:]])
