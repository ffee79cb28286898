#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The public headers are the reference: every public declaration says what it needs to say.

In the comment right before it, every

    type, macro   has a sentence and `@since`
    field         has a comment; that of a double has its unit or range
    function      has a sentence, `@since`, and unless it returns nothing `@return`
    status        in `@return` exists, is one that the code can return, and none that the function's
                  own code returns is left out; `as se3d_...` refers to another function's list
    parameter     that is no handle, object or structure is named; a double has a unit in brackets
                  (or is Euler parameters or a unit vector), an array of doubles a frame or a size
    thread word   (Reader, Exclusive, Safe) gives its reason in parentheses; the head of each header
                  says which rule holds

STATE is left out where it only means "called from a callback": se3d.h says so once. With a folder
as argument, that tree is checked instead of this one.
"""
import argparse
import re
import sys
from pathlib import Path

import check_size

COMMENT = r"/\*(?:(?!\*/).)*\*/"
FUNCTION = re.compile(r"^(?:SE3D_API|static inline) +([^;{]*?)\b(se3d_\w+)\(((?:[^()]|\([^()]*\))*)\)",
                      re.M | re.S)
TYPE = re.compile(r"^typedef (?:struct|enum) (se3d_\w+)|^typedef [^;{]*?\(\*(se3d_\w+)\)|"
                  r"^#define (SE3D_\w+)", re.M)
HIDDEN = re.compile(r"SE3D_(\w+_H|API|STATUS_ENUMERATOR)$")  # guards and helpers of the headers
UNIT = re.compile(r"\[[^\]]*[A-Za-z1%][^\]]*\]")
FRAME = re.compile(r"frame|->|Euler|\[\w+( \* \w+)?\]|\(rows|\[rows")
NO_UNIT = re.compile(r"Euler parameters|unit vector|direction|\[\w*(count|equations)\w*( \* \w+)?\]")
THREADS = re.compile(r"\b(Reader|Exclusive|Safe)\b(?! \()")


def words(comment):
    """The text of a comment on one line."""
    return " ".join(re.sub(r"^\s*\*+ ?", "", line) for line in
                    comment.strip()[2:-2].split("\n")).strip()


def comment_before(text, start):
    found = re.search(rf"({COMMENT})\n$", text[:start], re.S)
    if found:  # the last one only
        found = re.search(rf"{COMMENT}$", found.group(1)[found.group(1).rfind("/*"):], re.S)
    return words(found.group()) if found else ""


def sentence_problems(comment, since=True):
    if not comment:
        return ["no comment right before it"]
    problems = []
    if not re.match(r"[A-Z0-9(-]", comment):
        problems.append("the comment does not begin with a sentence")
    if since and not re.search(r"@since \d+\.\d+", comment):
        problems.append("no @since")
    if THREADS.search(comment):
        problems.append("a thread word without its reason in parentheses")
    return problems


def parameters(inside):
    """(type, name) of each parameter."""
    for part in re.split(r",(?![^(]*\))", " ".join(inside.split())):
        found = re.match(r"(.*?)(\w+)((?:\[\w*\])*)$", part.strip())
        if found and found.group(1):
            yield found.group(1) + found.group(3), found.group(2)


def parameter_problems(comment, inside):
    if re.search(r"@return as se3d_|^As se3d_", comment) and "@param" not in comment:
        return
    for kind, name in parameters(inside):
        if re.search(r"\bse3d_(?!status)", kind) and "[" not in kind or name == "ctx":
            continue
        said = re.search(rf"@param\[\w+\] {name} (.*?)(?=@param|@return|@since)", comment + "@since")
        if not said:
            yield f"nothing on the parameter `{name}`"
        elif "double" in kind:
            meaning = said.group(1)
            if not UNIT.search(meaning) and not NO_UNIT.search(meaning):
                yield f"no unit of the parameter `{name}`"
            if re.search(r"\[\d+\]", kind) and not FRAME.search(meaning):
                yield f"no frame of the parameter `{name}`"


def return_part(comment):
    found = re.search(r"@return (.*?)(?=@since|@param|$)", comment)
    return found.group(1) if found else None


def statuses(comment):
    """Names in an @return list, without what stands in parentheses."""
    return set(re.findall(r"\b[A-Z][A-Z_]+\b", re.sub(r"\([^()]*\)", "", return_part(comment) or "")))


class Code:
    """Which statuses the functions of lib/ can return, by the names that stand in their bodies."""

    def __init__(self, root):
        self.shared, self.local, self.made, self.found = {}, {}, {}, {}
        for path in [p for kind in ("c", "h", "inc") for p in sorted(root.glob(f"lib/**/*.{kind}"))]:
            text = path.read_text()
            lines, outside = text.split("\n"), []
            last = 0
            rows = list(check_size.functions(text))
            for _, first, end, _, _ in rows:
                outside += lines[last:first - 1]
                last = end
            tables = self.names("\n".join(outside + lines[last:]), r"\b(se3di_\w+|[a-z]\w+)\b")
            for name, first, end, _, _ in rows:
                body = "\n".join(lines[first - 1:end])
                body = check_size.NOISE.sub('""', body)
                calls = self.names(body, r"\b([a-z]\w+)\b") | tables
                if re.search(r"\bSE3DI_(EDIT|SET|OWNED)", body):
                    calls.add("se3di_enter")
                found = set(re.findall(r"\bSE3D_(?:ERR_)?((?:INFO_)?[A-Z_]+)\b", body))
                if "SE3DI_IO_GIVE_ENTRY" in body:
                    found |= {"NULL", "INVALID_ARGUMENT"}
                is_static = "static" in body.split("{")[0]
                place = self.local.setdefault(path, {}) if is_static else self.shared
                place[name] = (path, calls, found)
            self.add_tables(path, "\n".join(outside + lines[last:]))
            self.add_made(path, text)

    def add_made(self, path, text):
        """Functions that a list makes, se3di_find_##kind(..) {..}, by the beginning of their names."""
        for macro in re.findall(r"^#define \w+\(.*\n(?:.*\\\n)*.*", text, re.M):
            for prefix in re.findall(r"\b(se3di_\w+_)##\w+\([^;{]*\{", macro.replace("\\\n", "")):
                self.made[prefix] = (path, self.names(macro, r"\b([a-z]\w+)\b"), set())

    def add_tables(self, path, text):
        """Tables of functions, `const se3di_integrator se3di_integrator_rk4 = {..};`, call what they name."""
        for name, body in re.findall(r"^const \w+ (se3di_\w+) = \{(.*?)^\};", text, re.M | re.S):
            self.shared[name] = (path, self.names(body, r"\b([a-z]\w+)\b"), set())

    @staticmethod
    def names(text, pattern):
        return set(re.findall(pattern, check_size.NOISE.sub('""', text)))

    def look(self, path, name):
        if name.endswith("_") and name not in self.shared:  # se3di_force_class_##name of a list
            self.shared[name] = (path, {each for each in self.shared if each.startswith(name)}, set())
        made = next((self.made[each] for each in self.made if name.startswith(each)), None)
        return self.local.get(path, {}).get(name) or self.shared.get(name) or made

    def reach(self, name):
        """All statuses that the function can return, and more: every path counts."""
        if not self.found:
            self.follow_calls()
        return self.found[id(self.shared[name])]

    def follow_calls(self):
        """Add to what each function names what those that it calls can return, until no more comes."""
        entries, todo = {}, list(self.shared.values())
        while todo:
            entry = todo.pop()
            if id(entry) in entries:
                continue
            called = [self.look(entry[0], name) for name in entry[1]]
            entries[id(entry)] = {id(each) for each in called if each} - {id(entry)}
            self.found[id(entry)] = set(entry[2])
            todo += [each for each in called if each]
        grown = True
        while grown:
            grown = False
            for key, called in entries.items():
                before = len(self.found[key])
                self.found[key].update(*(self.found[each] for each in called))
                grown |= len(self.found[key]) > before


def status_problems(name, comment, docs, code, known):
    listed, seen = statuses(comment), {name}
    while True:
        other = re.search(r"\bas (se3d_\w+)", return_part(comment) or "")
        if not other:
            break
        if other.group(1) not in docs or other.group(1) in seen:
            yield f"@return refers to {other.group(1)}, which is not there"
            return
        seen.add(other.group(1))
        comment = docs[other.group(1)]
        listed |= statuses(comment)
    for status in sorted(listed - known - {"INFO_"}):
        yield f"@return {status}: there is no such status"
    twin = name if name in code.shared else f"{name}_sized"
    if twin in code.shared:
        free = {"OK", "NULL", "STATE", "INFO_"}
        for status in sorted((listed & known) - code.reach(twin) - free):
            yield f"@return {status}: the code never returns it"
        if "what the" not in comment and "or the status" not in comment:
            for status in sorted((code.shared[twin][2] & known) - listed - {"STATE", "OK"}):
                yield f"@return lacks {status}"


def function_problems(match, comment, docs, code, known):
    kind, name, inside = match.groups()
    yield from sentence_problems(comment)
    if name.endswith(("_def_init", "_options_init", "_settings_init", "_grid_init", "_default", "_sized")):
        return
    yield from parameter_problems(comment, inside)
    if kind.strip() == "void":
        return
    if return_part(comment) is None:
        yield "no @return"
    elif kind.strip() == "se3d_status" and "error_status" not in name:
        yield from status_problems(name, comment, docs, code, known)


def fields(text):
    """(place, name, own comment or the one above, that of the structure, is a double)."""
    for struct in re.finditer(r"^typedef struct \w+ \{\n(.*?)^\} (se3d_\w+);", text, re.M | re.S):
        whole, above = comment_before(text, struct.start()), ""
        for field in re.finditer(rf"^ +(?:({COMMENT})|([^/;]*?;)[ ]*({COMMENT})?)$", struct.group(1),
                                 re.M | re.S):
            if field.group(1):
                above = words(field.group(1))
            elif not re.search(r"\b(struct_size|reserved|index1|generation)\b", field.group(2)):
                said = words(field.group(3)) if field.group(3) else above
                name = re.findall(r"\w+", re.sub(r"\[.*?\]|\)\(.*", "", field.group(2)))[-1]
                is_double = re.match(r"(const )?double\b", field.group(2))
                yield (struct.start(1) + field.start(), f"{struct.group(2)}.{name}", said, whole,
                       is_double)
                above = ""


NUMBER = re.compile(r"\[[^\]]+\]|Euler parameters|unit vector|direction|\d ?\.\. ?\d|>= 0\b|"
                    r"ratio|default \d")


def check_header(path, docs, code, known):
    text = path.read_text()
    count, problems = 0, []

    def add(at, name, why):
        problems.append(f"{path.name}:{text.count(chr(10), 0, at) + 1}: {name}: {why}")

    if "Threads: " not in text[:text.find("#ifndef")]:
        add(0, "the head", "no rule on threads")

    for match in FUNCTION.finditer(text):
        count += 1
        for why in function_problems(match, docs[match.group(2)], docs, code, known):
            add(match.start(), match.group(2), why)
    for match in TYPE.finditer(text):
        name = next(g for g in match.groups() if g)
        if HIDDEN.match(name):
            continue
        line = text[match.start():text.find("\n", match.start())]
        before = text[:match.start()].rstrip("\n").split("\n")[-1]
        if match.group(3) and ("/*" in line or before.startswith("#define") or "(" in line):
            continue
        count += 1
        for why in sentence_problems(comment_before(text, match.start())):
            add(match.start(), name, why)
    for at, name, said, whole, is_double in fields(text):
        if not said:
            add(at, name, "no comment")
        elif is_double and not NUMBER.search(said) and not NUMBER.search(whole):
            add(at, name, "no unit or range")
    return count, problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    root = parser.parse_args().folder
    headers = sorted((root / "include" / "se3d").glob("*.h"))
    docs = {m.group(2): comment_before(text, m.start())
            for text in [h.read_text() for h in headers] for m in FUNCTION.finditer(text)}
    listed = re.findall(r"X\(SE3D_(?:ERR_)?(\w+),", (root / "include/se3d/base.h").read_text())
    code, count, problems = Code(root), 0, []
    for header in headers:
        some, bad = check_header(header, docs, code, set(listed))
        count += some
        problems += bad
    print("\n".join(problems + [f"headers: {count} declarations, {len(problems)} problems"]))
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
