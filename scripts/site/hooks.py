# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

"""Hooks of MkDocs for scripts/docs: docs/ is written for GitHub, and these turn it into a site.

* Files that the pages link to and that are outside docs/ become pages below source/.
* Comments are removed, and commands get the colors of a console.
* Headings have the names that links on GitHub use.
* At the end, no link may be broken, and nothing may come from the network.

The environment names the folder that scripts/docs prepared: BBSIM_SITE_MADE, with assets/ and replays/,
and the scenarios of its pages, BBSIM_SITE_PAGES.
"""

import json
import os
import posixpath
import re
import subprocess
from html.parser import HTMLParser
from urllib.parse import unquote, urlsplit

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
MADE = os.environ["BBSIM_SITE_MADE"]

# Pages of the site that are not in docs/, with the files of the repository that contain their text.
PAGES = {"changes.md": "CHANGELOG.md"}
# A link to one of these folders gives its files pages too.
WHOLE = ("configs/", "examples/", "scripts/examples/")
LANGUAGES = {".yaml": "yaml", ".yml": "yaml", ".py": "python", ".js": "javascript", ".awk": "awk", ".cmake": "cmake",
             ".c": "c", ".h": "cpp", ".hpp": "cpp", ".cpp": "cpp", ".ino": "cpp", ".sh": "sh"}
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)")

tracked = set()  # files of the repository
sources = {}  # path in the repository: page of the site


def repository_path(src_uri):
    return PAGES.get(src_uri, "docs/" + src_uri)


def lines_outside_fences(text):
    """(line, whether it is text rather than code) for each line; a list's own lines are indented too."""
    fence, in_list = None, False
    for line in text.split("\n"):
        marks = re.match(r"\s*(`{3,}|~{3,})", line)
        if fence is None and marks:
            fence = marks[1]
            yield line, False
        elif fence is not None:
            if line.strip() == fence:
                fence = None
            yield line, False
        else:
            if re.match(r"([-*+]|\d+\.) ", line):
                in_list = True
            elif re.match(r"\S", line):
                in_list = False
            yield line, not line.startswith("        " if in_list else "    ")


def with_links(line, change):
    """The line, with change(target) for the target of each link outside code."""
    result, end = [], 0
    for code in [*CODE.finditer(line), None]:
        text = line[end:code.start() if code else None]
        result.append(LINK.sub(lambda link: link[1] + change(link[2]) + link[3], text))
        if code:
            result.append(code[0])
            end = code.end()
    return "".join(result)


def target_path(target, page):
    """The path in the repository to which a link leads; None if it leaves the repository or stays on its page."""
    parts = urlsplit(target)
    if parts.scheme or not parts.path:
        return None
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), unquote(parts.path)))


def children(folder):
    """Names in a folder of the repository, those of folders with a slash."""
    inside = [path[len(folder) + 1:] for path in tracked if path.startswith(folder + "/")]
    return sorted({name.split("/")[0] + ("/" if "/" in name else "") for name in inside})


def source_page(path):
    is_folder = path not in tracked
    return f"source/{path}/index.md" if is_folder else f"source/{path}.md"


def add_source(path):
    if path in sources or path.startswith("docs/"):
        return
    if path not in tracked and not children(path):
        return  # MkDocs reports it
    sources[path] = source_page(path)
    if path not in tracked and (path + "/").startswith(WHOLE):
        for name in children(path):
            add_source(posixpath.join(path, name.rstrip("/")))


def on_config(config):
    config["mdx_configs"].setdefault("toc", {})["slugify"] = slug
    return config


def slug(text, separator):
    """The name of a heading in links, as in scripts/check-docs and on GitHub."""
    text = re.sub(r"[`*(),.:;!?'\"/\\+=<>{}\[\]|&%$#@^~]", "", text.strip().lower())
    return text.replace(" ", separator)


def on_files(files, config):
    tracked.update(subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True,
                                  text=True).stdout.split("\n"))
    tracked.discard("")
    pages = [file.src_uri for file in files.documentation_pages()] + list(PAGES)
    for page in pages:
        with open(os.path.join(ROOT, repository_path(page)), encoding="utf-8") as text:
            for line, is_text in lines_outside_fences(text.read()):
                if is_text:
                    with_links(line, lambda target: (note(target, repository_path(page)), target)[1])
    for page in [*PAGES, *sources.values()]:
        files.append(File(page, config["docs_dir"], config["site_dir"], False))
    for folder, _, names in os.walk(MADE):
        for name in names:
            path = os.path.relpath(os.path.join(folder, name), MADE)
            files.append(File(path, MADE, config["site_dir"], False))
    return files


def note(target, page):
    path = target_path(target, page)
    if path and path not in PAGES.values():
        add_source(path)


def on_nav(nav, config, files):
    named = {page.file.src_uri for page in nav.pages}
    missing = [file.src_uri for file in files.documentation_pages()
               if file.src_uri not in named and not file.src_uri.startswith("source/")]
    if missing:
        raise PluginError("scripts/site/mkdocs.yml: nav leaves out " + ", ".join(sorted(missing)))


def on_page_read_source(page, config):
    uri = page.file.src_uri
    if uri in PAGES:
        with open(os.path.join(ROOT, PAGES[uri]), encoding="utf-8") as text:
            return text.read()
    for path, source in sources.items():
        if source == uri:
            return source_text(path)
    return None


def title_of(name):
    with open(os.path.join(ROOT, "configs", name + ".yaml"), encoding="utf-8") as scenario:
        title = re.search(r"^title: *(.*)$", scenario.read(), re.MULTILINE)
    return title[1].strip("\"'") if title else name


def gallery():
    """The pages that scripts/docs made, each with a picture and its title."""
    parts = ["\n## All pages\n\nClick a picture.\n\n<div class=\"gallery\" markdown>\n"]
    for name in os.environ["BBSIM_SITE_PAGES"].split():
        parts.append(f"""
<section markdown>
<a href="replays/{name}.html" target="_blank"><img src="replays/{name}.png" alt="" loading="lazy"></a>

**<a href="replays/{name}.html" target="_blank">{name}</a>** · [scenario](source/configs/{name}.yaml.md)

{title_of(name)}
</section>
""")
    return "".join(parts) + "\n</div>\n"


def source_text(path):
    """A page that shows a file, or lists a folder, of the repository."""
    hidden = f"---\ntitle: {path}\n---\n"
    if path not in tracked:
        lines = []
        for name in children(path):
            child = posixpath.join(path, name.rstrip("/"))
            page = sources.get(child)
            link = page and posixpath.relpath(page, posixpath.dirname(sources[path]))
            lines.append(f"* [`{name}`]({link})" if link else f"* `{name}`")
        return f"{hidden}# `{path}/`\n\nA folder of the sources.\n\n" + "\n".join(lines) + "\n"
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        text = file.read()
    suffix = os.path.splitext(path)[1]
    language = LANGUAGES.get(suffix, "sh" if text.startswith("#!") else "cmake" if "CMakeLists" in path else "text")
    return f"{hidden}# `{path}`\n\n~~~~~~~~{language}\n{text.rstrip()}\n~~~~~~~~\n"


def on_page_markdown(markdown, page, config, files):
    uri = page.file.src_uri
    if uri.startswith("source/"):
        return markdown  # written for the site
    here = repository_path(uri)

    def change(target):
        path = target_path(target, here)
        if path is None:
            return target
        fragment = urlsplit(target).fragment
        known = {path: page for page, path in PAGES.items()}
        if path in known:
            to = known[path]
        elif path in sources:
            to = sources[path]
        elif path.startswith("docs/"):
            to = path[len("docs/"):]
        else:
            return target
        return posixpath.relpath(to, posixpath.dirname(uri) or ".") + ("#" + fragment if fragment else "")

    lines, command, previous = [], False, ""
    for line, is_text in lines_outside_fences(markdown):
        if is_text and re.match(r"<!--.*-->\s*$", line):
            # The separate comment keeps adjacent blocks of code apart.
            lines += ["", "<!-- -->", ""]
            command, previous = False, ""
            continue
        is_indented = line.startswith("    ") and not is_text
        if command and (is_indented or not line.strip()):
            lines.append(line[4:])
            previous = line
            continue
        if command:
            close(lines)
            command = False
        if is_indented and not previous.strip() and line.startswith("    $ "):
            lines.append("```console")
            lines.append(line[4:])
            command = True
        else:
            lines.append(with_links(line, change) if is_text else line)
        previous = line
    if command:
        close(lines)
    text = "\n".join(lines)
    if uri == "index.md":
        text = re.sub(r"^(!\[[^\]]*\]\([^)]*\))$", r"[\1](try.md)", text, count=1, flags=re.MULTILINE)
    if uri == "try.md":
        text += gallery()
    return text


def close(lines):
    """Ends a block of commands before the blank lines below it."""
    end = len(lines)
    while not lines[end - 1].strip():
        end -= 1
    lines.insert(end, "```")


def on_post_build(config):
    """Removes the sources from the search, makes it work without a server, and checks all links."""
    site = config["site_dir"]
    index_file = os.path.join(site, "search", "search_index.json")
    with open(index_file, encoding="utf-8") as file:
        index = json.load(file)
    index["docs"] = [entry for entry in index["docs"] if not entry["location"].startswith("source/")]
    text = json.dumps(index, separators=(",", ":"))
    with open(index_file, "w", encoding="utf-8") as file:
        file.write(text)
    with open(os.path.join(site, "search", "search_index.js"), "w", encoding="utf-8") as file:
        file.write(f"var __search = {{index: Promise.resolve({text})}};\n")
    check(site)


class Links(HTMLParser):
    """The names that a page has, what it links to, and what a browser loads with it."""

    def __init__(self):
        super().__init__()
        self.names, self.links, self.loads = set(), [], []

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        if "id" in values:
            self.names.add(values["id"])
        if tag in ("a", "area") and "href" in values:
            self.links.append(values["href"])
        elif tag == "link" and values.get("rel") not in ("canonical",) and "href" in values:
            self.loads.append(values["href"])
        for name in ("src", "poster", "data"):
            if name in values:
                self.loads.append(values[name])


def check(site):
    pages = {}
    for folder, folders, names in os.walk(site):
        if folder == site:
            folders.remove("replays")  # a browser tests them
        for name in names:
            if name.endswith(".html") and name != "404.html":
                path = os.path.relpath(os.path.join(folder, name), site)
                pages[path] = Links()
                with open(os.path.join(folder, name), encoding="utf-8") as file:
                    pages[path].feed(file.read())
    faults = []
    for path, page in pages.items():
        for address in page.loads:
            if urlsplit(address).scheme not in ("", "data") or address.startswith("//"):
                faults.append(f"{path}: loads {address} from the network")
        for address in page.links + page.loads:
            parts = urlsplit(address)
            if parts.scheme or parts.netloc:
                continue
            to = path
            if parts.path:
                to = os.path.normpath(os.path.join(os.path.dirname(path), unquote(parts.path)))
                if os.path.isdir(os.path.join(site, to)):
                    to = os.path.normpath(os.path.join(to, "index.html"))
            if not os.path.exists(os.path.join(site, to)):
                faults.append(f"{path}: {address} leads nowhere")
            elif parts.fragment and to in pages and unquote(parts.fragment) not in pages[to].names:
                faults.append(f"{path}: {address} names no heading")
    for folder, _, names in os.walk(os.path.join(site, "assets")):
        for name in names:
            if name.endswith(".css"):
                with open(os.path.join(folder, name), encoding="utf-8") as file:
                    for address in re.findall(r"url\(['\"]?((?:https?:)?//[^)]*)", file.read()):
                        faults.append(f"{name}: loads {address} from the network")
    if faults:
        raise PluginError("\n".join(faults))
