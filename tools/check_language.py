#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The English of documentation, comments and messages, as docs/glossary.md has it.

    words      phrases that were thought in another language
    synonyms   in identifiers and comments of C files, a second word for a thing that has one
    formulas   in a comment, text right after a formula is a formula that was broken: leave a line
    Markdown   at most 120 columns outside tables, code and links
    conflicts  both sides of a merge, left in a file with their marks

With `wrap FILE.md...` the paragraphs of these files are wrapped; with a folder as argument, that
tree is checked instead of this one.
"""
import re
import sys
from pathlib import Path

COLUMNS = 120
BANNED = (
    (r"of the (user|caller)'s\b(?=[.,;:)*]|$| (in|by|that|and|has|is|at|on|to|from|which|as)\b)",
     "user-defined, by the caller"),
    (r"square to\b", "perpendicular to"),
    (r"\b(the|its|their|a) begin\b(?! [a-z]+\()", "beginning or start"),
    (r"what (is|was) typed\b|\bas typed\b|\btyped is\b", "the value given"),
    (r"which (this|the) \w+ has not\b", "which it does not have"),
    (r"is none, but\b|\bthat (is|are) none\b|\bwas none,", "is not a ..."),
    (r"(?:^|[.:;!?] |\*\* |\* )Where [a-z`]", "If ..., When ..., or The place where ..."),
    (r"\b(NULL|null|false|true|zero|NaN|-?[01]) where (there|it|they|no|none|nothing)\b", "if"),
    (r"where (there|it) (is|are|has) none\b", "if there is none"),
    (r"(?<!place)(?<!point); where (it|they|that|this|one|an?|the|no|there)\b",
     "; if ..."),
    (r"\b([Dd]egenerate|singular|redundant|void|halved|shorter|smaller|not a number) where\b", "if"),
    (r"\bwhere (it|they|that|this|one|a|an|the) ?(call|callback|memory|room)? fails\b", "if it fails"),
    (r"\bwhere (it is|they are|that is|one is|memory is|room is) (missing|wanted|asked for|NULL)\b", "if"),
    (r"\bfails with [A-Z_]+ where\b", "if"),
    (r"holds? (the|its|their) steps?\b", "limits the step"),
    (r"is no (column|channel|single|material|constant)\b", "is not a"),
    (r"come to a dead point\b", "reached a dead point"),
    (r"of nothing has\b", "of zero has"),
)
SYNONYM = re.compile(r"(?i:grain)s?(?![a-z])")
STRING = re.compile(r'"(?:\\.|[^"\\\n])*"')
KINDS = {".c", ".h", ".inc", ".md", ".py", ".sh", ".yaml"}
FOLDERS = ("include", "lib", "tools", "examples", "tests", "fuzz", "bench", "docs", "cmake", ".ci")
ITEM = re.compile(r"\s*(?:(?:[-*+]|\d+\.) +)?")
COMMENT = re.compile(r"/\*(?:(?!\*/).)*\*/", re.S)
CONFLICT = re.compile(r"^(?:<{7}|>{7}) \S", re.M)
BROKEN = re.compile(r"^ *\* {4,}\S[^\n]*\n *\* ?(?! )[^\s/@*][^\n]*", re.M)


def files(root):
    yield from (p for p in sorted(root.glob("*.md")))
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in KINDS and path.is_file() and path.name not in (
                    "check_language.py", "glossary.md", "test_checks_can_fail.sh"):
                yield path


def flat(text):
    """Newlines within a paragraph or comment become blanks, so that a phrase may go over two lines;
    positions stay."""
    return re.sub(r"\n( *\*?)(?= *[^\s*/|#])(?! *[-+] )(?! {4})",
                  lambda m: " " + "\0" * len(m.group(1)), text)


RULES = tuple((re.compile(pattern.replace(" ", r"[ \0]+"), re.M), better) for pattern, better in BANNED)
LIKELY = re.compile(r"(user|caller)'s|square|begin|typed|has not|none|Where|where|\bholds?\b|is no\b|"
                    r"come to|nothing")


def check_words(text, name, problems):
    if not LIKELY.search(text):
        return
    plain = flat(text)
    for pattern, better in RULES:
        for match in pattern.finditer(plain):
            line = text.count("\n", 0, match.start()) + 1
            words = " ".join(match.group().replace("\0", "").split())
            problems.append(f"{name}:{line}: `{words[:60]}`: {better}")


def check_synonyms(text, name, problems):
    """What users read or write in strings may have a name of its own: files, data."""
    for match in SYNONYM.finditer(STRING.sub(lambda m: " " * len(m.group()), text)):
        line = text.count("\n", 0, match.start()) + 1
        problems.append(f"{name}:{line}: `{match.group()}`: particle")


def check_formulas(text, name, problems):
    for comment in COMMENT.finditer(text):
        for match in BROKEN.finditer(comment.group()):
            line = text.count("\n", 0, comment.start() + match.start()) + 2
            problems.append(f"{name}:{line}: text right after a formula, leave an empty line")


def check_conflicts(text, name, problems):
    for match in CONFLICT.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        problems.append(f"{name}:{line}: the mark of a conflict")


def blocks(text):
    """Yield (is a paragraph, lines): code, tables, headings and empty lines are none."""
    paragraph, fence = [], False
    for line in text.split("\n"):
        is_mark = line.lstrip().startswith("```")
        if is_mark or fence or not line.strip() or line.startswith(("|", "#", "![", "<")) or (
                line.startswith("    ") and not paragraph):
            if paragraph:
                yield True, paragraph
            paragraph = []
            yield False, [line]
            fence = fence != is_mark
        else:
            if paragraph and re.match(r"\s*([-*+]|\d+\.) ", line):
                yield True, paragraph
                paragraph = []
            paragraph.append(line)
    if paragraph:
        yield True, paragraph


def wrap(lines):
    """A paragraph of Markdown in lines of COLUMNS; none begins with what would be a mark."""
    first = ITEM.match(lines[0]).group()
    indent = " " * len(first) if first.strip() or len(lines) == 1 else ITEM.match(lines[1]).group()
    rows, row = [], []
    for word in " ".join([lines[0][len(first):]] + lines[1:]).split():
        if row and len(indent) + len(" ".join(row + [word])) > COLUMNS:
            carry = [word]
            while re.match(r"([-+*#>|=]+|\d+[.)])$|[#|]", carry[0]) and len(row) > 1:
                carry.insert(0, row.pop())
            rows.append(" ".join(row))
            row = carry
        else:
            row.append(word)
    rows.append(" ".join(row))
    return [first + rows[0]] + [indent + text for text in rows[1:]]


def check_markdown(text, name, problems):
    line = 1
    for is_paragraph, lines in blocks(text):
        for k, content in enumerate(lines):
            if is_paragraph and len(content) > COLUMNS and " " in content.strip():
                problems.append(f"{name}:{line + k}: {len(content)} columns, at most {COLUMNS}: "
                                f"python3 tools/check_language.py wrap {name}")
        line += len(lines)


def rewrap(names):
    for name in names:
        path = Path(name)
        path.write_text("\n".join(
            line for is_paragraph, lines in blocks(path.read_text()) for line in
            (wrap(lines) if is_paragraph and max(map(len, lines)) > COLUMNS else lines)))


def main():
    if sys.argv[1:2] in (["-h"], ["--help"]):
        print(__doc__)
        return 0
    if sys.argv[1:2] == ["wrap"]:
        return rewrap(sys.argv[2:])
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    count, problems = 0, []
    for path in files(root):
        text, name = path.read_text(), str(path.relative_to(root))
        count += 1
        check_words(text, name, problems)
        check_conflicts(text, name, problems)
        if path.suffix in (".c", ".h", ".inc"):
            check_formulas(text, name, problems)
            check_synonyms(text, name, problems)
        if path.suffix == ".md":
            check_markdown(text, name, problems)
    print("\n".join(problems + [f"language: {count} files, {len(problems)} problems"]))
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
