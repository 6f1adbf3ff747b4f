"""The gallery as a page. It reads the list of the examples and their pictures from docs/site/build, one per line:

  stage    NAME   DESCRIPTION   COMMAND
  picture  FILE   CAPTION

Fields are separated by tabs.

"""
import html
import sys

print("# Gallery {#site_gallery}\n")
print("`examples/run` builds the examples, runs them one after the other and draws these pictures. `examples/run NAME` runs one of them.\n")
stages = []
for line in sys.stdin.read().splitlines():
    kind, *fields = line.split("\t")
    if kind == "stage":
        stages.append((*fields, []))
    else:
        stages[-1][-1].append(fields)
for name, shows, command, pictures in stages:
    print(f"## {name.replace('_', ' ').capitalize().replace(' fe', ' finite elements')}\n\n{shows}\n")
    print(f"```sh\nexamples/run {name}   # builds it, and runs: {command}\n```\n")
    if pictures:
        print("\\htmlonly\n<div class=\"gallery\">")
        for path, caption in (map(html.escape, picture) for picture in pictures):
            print(f"<figure><a href=\"{path}\"><img loading=\"lazy\" src=\"{path}\" alt=\"{caption}\"/></a><figcaption>{caption}</figcaption></figure>")
        print("</div>\n\\endhtmlonly\n")
if not any(pictures for *_, pictures in stages):
    print("This site was built before any example ran. Run `examples/run`, then `docs/site/build` again.")
