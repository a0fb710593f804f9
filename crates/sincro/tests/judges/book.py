"""Checks the book: `python3 book.py BOOK`, the folder that `mdbook build` has written. Every link within it must lead to a
file that is there, and to an anchor of it; links out of it are not followed."""

import pathlib
import re
import sys
import urllib.parse

# made by mdBook of other pages
COMPOSED = {"print.html", "toc.html", "404.html"}


def main(book):
    pages = {path.resolve(): path.read_text(encoding="utf-8") for path in book.rglob("*.html")}
    anchors = {path: set(re.findall(r'id="([^"]+)"', text)) for path, text in pages.items()}
    broken = []
    n_links = 0
    for path, text in pages.items():
        if path.name in COMPOSED:
            continue
        body = re.search(r"<main>(.*)</main>", text, re.S)
        if not body:
            sys.exit(f"{path} has no <main>: another mdBook? This was written for 0.5")
        for link in re.findall(r'(?:href|src)="([^"]+)"', body.group(1)):
            link = link.replace("&amp;", "&")
            if re.match(r"[a-z]+:", link):
                continue
            n_links += 1
            target, _, anchor = link.partition("#")
            file = (path.parent / urllib.parse.unquote(target)).resolve() if target else path
            if not file.exists():
                broken.append(f"{path.name}: `{link}` leads nowhere")
            elif anchor and file in anchors and urllib.parse.unquote(anchor) not in anchors[file]:
                broken.append(f"{path.name}: `{link}` names a place that is not there")
    print(f"{len(pages)} pages, {n_links} links within the book, {len(broken)} broken")
    print("\n".join(broken))
    sys.exit(1 if broken or n_links == 0 else 0)


main(pathlib.Path(sys.argv[1]))
