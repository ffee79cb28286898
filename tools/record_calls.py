#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes, from the public headers, what records the calls of a program and what plays them again.

    record_calls.py FOLDER    layouts.c, recorded.c and played.c (record/layout.h)
    record_calls.py           whether all functions can be recorded

How long an array is stands in its description in the header, as [count * 3]: numbers, parameters or
members, and the words of WORDS. What has no layout that follows from the header is an error.
"""
import argparse
import re
import sys
from pathlib import Path

from check_abi import IO_HEADERS
from check_headers import COMMENT, FUNCTION, comment_before, parameters, words

ROOT = Path(__file__).resolve().parent.parent
NUMBERS = "double int int32_t uint32_t int64_t uint64_t size_t".split()
COUNTS = "size_t int32_t uint32_t".split()
UNIT = re.compile(r"\[(kg|m|s|N|J|W|rad|relative|any unit|unit of|its unit)\b")

# What a word in brackets stands for, by the noun of the function's name; {0} is its first argument.
WORDS = {
    ("batch", "states"): "se3d_batch_count({0})",
    ("batch", "positions"): "se3d_batch_count_positions({0})",
    ("batch", "velocities"): "se3d_batch_count_velocities({0})",
    ("coordinates", "positions"): "se3d_coordinates_count_positions({0})",
    ("coordinates", "velocities"): "se3d_coordinates_count({0})",
    ("coordinates", "loop rows"): "se3d_coordinates_count_loop_rows({0})",
    ("constraint", "equations"): "layout_equations({0}, layout_parameter(base, 1))",
    ("expression", "variable_count"): "layout_recall(walk, layout_parameter(base, 0), sizeof(void *))",
    ("function", "variable_count"):
        "layout_recall(walk, layout_parameter(base, 1), sizeof(se3d_function))",
}
# An array whose length depends on more.
LENGTHS = {
    ("se3d_constraint_eval_jacobian", "phi_rotation"):
        "layout_times(layout_equations({0}, layout_parameter(base, 1)), "
        "*(const se3d_formulation *)layout_parameter(base, 2) == SE3D_FORMULATION_RP ? 4 : 3)",
    ("se3d_tyre_get_some", "values"): "SE3D_TYRE_VALUES",
    ("se3d_tyre_get_several", "values"):
        "layout_times(*(const size_t *)layout_parameter(base, 1), SE3D_TYRE_VALUES)",
}
# Arrays of callbacks: the definition that holds the callback, and lengths as its members.
CALLBACKS = {
    "se3d_function_callback": ("se3d_function_def",
                               {"x": "variable_count", "gradient": "variable_count"}),
    "se3d_constraint_callback": ("se3d_user_constraint_def", {
        "bodies": "body_count", "phi": "equation_count", "nu": "equation_count",
        "gamma": "equation_count", "jacobian": "equation_count * body_count * 6"}),
    "se3d_force_callback": ("se3d_force_callback_def", {"K": "144", "D": "144"}),
}


class Problem(Exception):
    """What cannot be recorded."""


class Value:
    """A parameter or a member: its C type taken apart."""

    def __init__(self, kind, name, said=""):
        self.name, self.said = name, said
        self.dims = re.findall(r"\[(\w+)\]", kind)
        self.type = re.sub(r"\[\w+\]", "", kind).strip()
        plain = re.sub(r"\bconst\b", "", self.type).replace(" ", "")
        self.stars, self.plain = plain.count("*"), plain.replace("*", "")
        last = self.type.rstrip("* ") if self.stars < 2 else self.type[:self.type.rindex("*")]
        self.const = bool(re.search(r"\bconst\b", last)) if self.stars < 2 else last.endswith("const ")\
            or last.endswith("const")


class Headers:
    """The types and functions of the public headers."""

    def __init__(self):
        self.functions, self.io, self.callbacks, self.structs = [], [], {}, {}
        self.handles, self.owners, self.enums = [], [], []
        for path in sorted((ROOT / "include" / "se3d").glob("*.h")):
            self.read(path.read_text(), path.name in IO_HEADERS)

    def read(self, text, is_io):
        functions = [(m.group(1).strip(), m.group(2), m.group(3), comment_before(text, m.start()))
                     for m in FUNCTION.finditer(text) if m.group(0).startswith("SE3D_API")]
        if is_io:
            self.io += functions
            return
        for kind, name, inside, comment in functions:
            values = [Value(k, n, described(comment, n)) for k, n in parameters(inside)]
            self.functions.append((kind, name, values))
        self.owners += re.findall(r"^typedef struct (se3d_\w+) \1;", text, re.M)
        self.enums += re.findall(r"^typedef enum (se3d_\w+)", text, re.M)
        for kind, name, inside, comment in [
                m.group(1, 2, 3) + (comment_before(text, m.start()),) for m in
                re.finditer(r"^typedef (\w+) \(\*(se3d_\w+)\)\(([^;]*)\);", text, re.M | re.S)]:
            values = [Value(k, n) for k, n in parameters(inside)]
            self.callbacks[name] = (kind, values, "several threads" in comment)
        for m in re.finditer(r"^typedef struct \w+ \{\n(.*?)^\} (se3d_\w+);", text, re.M | re.S):
            found = list(members(m.group(1)))
            if [v.name for v in found] == ["index1", "generation"]:
                self.handles.append(m.group(2))
            elif m.group(2) != "se3d_allocator":
                self.structs[m.group(2)] = found


def described(comment, name):
    said = re.search(rf"@param\[\w+\] {name} (.*?)(?=@param|@return|@since)", comment + "@since")
    return said.group(1).strip() if said else ""


def members(body):
    """The members of a structure with their comments."""
    for m in re.finditer(rf"({COMMENT})|([^/;]+);(?:\s*({COMMENT}))?", body, re.S):
        if m.group(1) or "(*" in m.group(2):
            continue
        said = words(m.group(3)) if m.group(3) else ""
        first, *others = re.split(r",\s*", " ".join(m.group(2).split()))
        kind, name = re.match(r"(.*?)((?:\w+)(?:\[\w+\])*)$", first).groups()
        for each in [name] + others:
            bare, dims = re.match(r"(\w+)(.*)$", each).groups()
            yield Value(kind + dims, bare, said)


def product(factors):
    result = factors[0]
    for factor in factors[1:]:
        result = f"layout_times({result}, {factor})"
    return result


class Layouts:
    """Tables of all functions, callbacks and structures, as C."""

    def __init__(self):
        self.headers = Headers()
        self.numbers = {name: k for k, name in enumerate(self.headers.callbacks)}
        self.structs = {name: k for k, name in enumerate(self.headers.structs)}
        self.lengths = {}
        self.lines = []

    def length(self, code):
        """The name of the C function that computes `code`."""
        return self.lengths.setdefault(code, f"length_{len(self.lengths)}")

    def kind(self, v):
        """(kind, C type, number, structure, pointers that are left) of a value."""
        h = self.headers
        if v.plain == "void" and v.stars == 1 and v.name.endswith("ctx"):
            return "CONTEXT", "void *", 0, None, 0
        if v.plain == "char" and v.stars == 1 and not v.const:
            return "BYTES", "char", 0, None, 1
        if v.plain == "char" and v.stars >= 1:
            return "TEXT", "char *", 0, None, v.stars - 1
        if v.plain in h.owners and v.stars >= 1:
            return "OWNER", "void *", h.owners.index(v.plain), None, v.stars - 1
        if v.plain in h.handles:
            return "HANDLE", v.plain, h.handles.index(v.plain), None, v.stars
        if v.plain in self.numbers:
            return "CALLBACK", v.plain, self.numbers[v.plain], None, v.stars
        if v.plain == "se3d_allocator":
            return "ALLOCATOR", "void *", 0, None, v.stars - 1
        if v.plain in self.structs:
            return "STRUCT", v.plain, 0, v.plain, v.stars
        if v.plain in NUMBERS or v.plain in h.enums or v.plain == "char":
            return "BYTES", v.plain, 0, None, v.stars
        if v.plain == "void" and v.stars == 1:
            return "BYTES", "char", 0, None, 1
        raise Problem(f"`{v.name}`: nothing is known of the type {v.type}")

    def row(self, v, is_member):
        """The layout of a value as a dictionary of the members of layout_item."""
        kind, type_, number, of, left = self.kind(v)
        row = {"name": f'"{v.name}"', "kind": f"LAYOUT_{kind}", "size": f"sizeof({type_})",
               "number": number, "count": "1", "pointer": left}
        if type_ == "double":
            row["is_real"] = 1
        if of:
            row["of"] = f"&layout_structs[{self.structs[of]}]"
        if v.dims and v.plain == "char":
            row.update(kind="LAYOUT_CHARACTERS", size=v.dims[0])
        elif v.dims:
            row.update(count=" * ".join(v.dims), pointer=0 if is_member else 1)
        if row["pointer"] > 1:
            raise Problem(f"`{v.name}`: nothing is known of the type {v.type}")
        return row

    def factor(self, text, noun, names):
        if text.isdigit():
            return text
        if text.lstrip("*") in names:
            return names[text.lstrip("*")]
        return WORDS[noun, text].format(names.get("", ""))

    def bracket(self, said, noun, names, pattern=r"\[([^\]]+)\]"):
        """The first length in brackets, as C; None: there is none."""
        for inside in re.findall(pattern, said):
            try:
                return product([self.factor(part, noun, names)
                                for part in re.split(r"\s+[x*]\s+", inside.strip())])
            except KeyError:
                continue
        return None

    def parameter_rows(self, name, values):
        names = {}
        for k, v in enumerate(values):
            if v.plain in COUNTS and v.stars == 0:
                names[v.name] = f"(size_t)*(const {v.plain} *)layout_parameter(base, {k})"
            elif v.plain == "size_t" and v.stars == 1:
                names[v.name] = f"pointed(layout_parameter(base, {k}))"
        names[""] = "*(const void *const *)layout_parameter(base, 0)"
        rows = []
        for k, v in enumerate(values):
            row = self.row(v, False)
            row["way"] = self.way(name, v, row)
            if row["pointer"]:
                self.add_lengths(row, v, k, name, names)
            rows.append(row)
        return rows

    def way(self, name, v, row):
        if not row["pointer"] or v.const:
            return "LAYOUT_IN"
        if v.plain in self.structs and self.is_sized(v.plain) and \
                not re.search(r"_get|_sized$|_init$", name):
            return "LAYOUT_BOTH"
        return "LAYOUT_OUT"

    def is_sized(self, struct):
        return self.headers.structs[struct][0].name == "struct_size"

    def add_lengths(self, row, v, k, name, names):
        noun = name.split("_")[1]
        is_output = row["way"] != "LAYOUT_IN"
        if row["kind"] == "LAYOUT_STRUCT" and is_output and "size" in names:
            row["stride"] = self.length(names["size"])
        if v.dims:
            return
        room = self.bracket(v.said, noun, names, r"room for ([\w x*]+)")
        if (name, v.name) in LENGTHS:
            code = LENGTHS[name, v.name].format(names[""])
        elif v.type == "char *":
            room = names.get("size") or names["capacity"]
            code = f"layout_characters(*(char *const *)layout_parameter(base, {k}), {room})"
        else:
            code = self.bracket(v.said, noun, names)
            if is_output and code and "capacity" in names:
                room = names["capacity"]
                code = f"layout_at_most({room}, {code})"
        if code:
            row["length"] = self.length(code)
        elif not (is_output or self.is_single(v)) or v.plain == "void" or \
                (v.said.startswith("[") and not UNIT.match(v.said)):
            raise Problem(f"{name}: no length of `{v.name}` stands in its description")
        if room:
            row["room"] = self.length(room)
        elif code and "pointed(" in code:
            raise Problem(f"{name}: it is not known how much room there is at `{v.name}`")

    def is_single(self, v):
        return v.plain in self.structs or v.plain in self.headers.handles

    def member_rows(self, struct):
        values = self.headers.structs[struct]
        names = {v.name: f"(size_t)((const {struct} *)base)->{v.name}" for v in values
                 if v.plain in COUNTS and v.stars == 0 and not v.dims}
        rows = []
        for v in values:
            row = self.row(v, True)
            row["offset"] = f"offsetof({struct}, {v.name})"
            if row["pointer"]:
                code = self.bracket(v.said, "", names)
                if code:
                    row["length"] = self.length(code)
                elif not (v.plain in self.structs and self.is_sized(v.plain)):
                    raise Problem(f"{struct}: no length of `{v.name}` stands in its comment")
            rows.append(row)
        return self.pair(struct, rows, lambda k: rows[k]["offset"])

    def callback_rows(self, callback):
        values = self.headers.callbacks[callback][1]
        holder, lengths = CALLBACKS.get(callback, (None, {}))
        rows = []
        for v in values:
            row = self.row(v, False)
            row["way"] = "LAYOUT_IN" if v.const or not row["pointer"] else "LAYOUT_OUT"
            if v.name in lengths:
                row["length"] = self.length(product([
                    each if each.isdigit() else f"(size_t)((const {holder} *)walk->definition)->{each}"
                    for each in lengths[v.name].split(" * ")]))
            elif row["pointer"] and not v.dims and row["way"] == "LAYOUT_IN" and \
                    v.plain not in self.structs:
                raise Problem(f"{callback}: the length of `{v.name}` is not in CALLBACKS")
            rows.append(row)
        return rows

    def pair(self, owner, rows, place):
        """Tell each callback its context: `<name>_ctx`, or `ctx`."""
        at = {row["name"].strip('"'): k for k, row in enumerate(rows)}
        for row in rows:
            if row["kind"] == "LAYOUT_CALLBACK":
                own = [at[n] for n in (row["name"].strip('"') + "_ctx", "ctx") if n in at]
                if not own:
                    raise Problem(f"{owner}: no context of the callback {row['name']}")
                row["partner"] = place(own[0])
        return rows

    def remembers(self, values):
        """The number of variables of what a function makes."""
        for k, v in enumerate(values):
            if v.plain in self.structs and v.const and \
                    any(m.name == "variable_count" for m in self.headers.structs[v.plain]):
                return self.length(f"variables_of({v.plain}, layout_parameter(base, {k}))")
        return None

    def emit_rows(self, title, rows):
        if not rows:
            return "NULL"
        self.lines.append(f"static const layout_item {title}[] = {{")
        for row in rows:
            inside = ", ".join(f".{key} = {value}" for key, value in row.items() if value)
            self.lines.append(f"    {{{inside}}},")
        self.lines.append("};")
        return title

    def function(self, title, kind, name, rows, more):
        table = self.emit_rows(title, rows)
        result = "NULL"
        if kind != "void":
            result = "&" + self.emit_rows(f"{title}_result", [self.row(Value(kind, "result"), False)]) + "[0]"
        inside = f'.name = "{name}", .parameters = {table}, .parameter_count = {len(rows)}, ' \
                 f".result = {result}, .has_status = {int(kind == 'se3d_status')}"
        return f"    {{{inside}{more}}},"

    def tables(self):
        """The C text of layouts.c."""
        h, functions, callbacks, structs = self.headers, [], [], []
        for k, (kind, name, values) in enumerate(h.functions):
            rows = self.pair(name, self.parameter_rows(name, values), str)
            more = ", .destroys = 1" if re.match(r"se3d_\w+_destroy$", name) and len(values) == 1 else ""
            if self.remembers(values):
                more += f", .remembers = {self.remembers(values)}"
            functions.append(self.function(f"function_{k}", kind, name, rows, more))
        for k, (name, (kind, _, concurrent)) in enumerate(h.callbacks.items()):
            callbacks.append(self.function(f"callback_{k}", kind, name, self.callback_rows(name),
                                           ", .is_concurrent = 1" if concurrent else ""))
        for k, name in enumerate(h.structs):
            rows = self.member_rows(name)
            table = self.emit_rows(f"members_{k}", rows)
            structs.append(f'    {{.name = "{name}", .size = sizeof({name}), .is_sized = '
                           f"{int(self.is_sized(name))}, .members = {table}, .member_count = {len(rows)}}},")
        lengths = [f"static size_t {name}(const layout_walk *walk, const void *base)\n{{\n"
                   f"    (void)walk;\n    (void)base;\n    return {code};\n}}\n"
                   for code, name in self.lengths.items()]
        return "\n".join([LAYOUTS_HEAD, *lengths, *self.lines,
                          table_of("layout_struct", "layout_structs", structs),
                          table_of("layout_function", "layout_functions", functions, "layout_function_count"),
                          table_of("layout_function", "layout_callbacks", callbacks, "layout_callback_count"),
                          table_of("char *const", "layout_owners", [f'    "{n}",' for n in h.owners],
                                   "layout_owner_count")])


HEAD = "/* SPDX-License-Identifier: BSD-3-Clause */\n/* Written by tools/record_calls.py. */\n"
LAYOUTS_HEAD = HEAD + """#include <string.h>

#include "layout.h"
#include "se3d/se3d.h"

static size_t pointed(const void *parameter)
{
    const size_t *pointer;
    memcpy(&pointer, parameter, sizeof pointer);
    return pointer ? *pointer : 0;
}

#define variables_of(type, parameter)                                                              \\
    (*(const type *const *)(parameter) ? (*(const type *const *)(parameter))->variable_count : 0)
"""


def table_of(kind, name, rows, count=None):
    text = f"const {kind} {name}[] = {{\n" + "\n".join(rows) + "\n};"
    if count:
        text += f"\nconst size_t {count} = {len(rows)};"
    return text


def declaration(kind, name, values, prefix="p"):
    inside = ", ".join(f"{v.type}{'' if v.type.endswith('*') else ' '}{prefix}{k}" +
                       "".join(f"[{d}]" for d in v.dims) for k, v in enumerate(values))
    return f"{kind}{'' if kind.endswith('*') else ' '}{name}({inside or 'void'})"


def arguments(values):
    return ", ".join(f"&p{k}" for k in range(len(values))) or "NULL"


def passed(values):
    return ", ".join(f"p{k}" for k in range(len(values)))


def recorded(h):
    """recorded.c: each public function under its own name, and callbacks in the place of the host's."""
    parts = [HEAD + '#include "recorder.h"\n#include "se3d/se3d.h"\n#include "se3d/import.h"\n'
             '#include "se3d/io.h"\n#include "se3d/study.h"\n']
    for k, (kind, name, values) in enumerate(h.functions):
        is_void = kind == "void"
        result = "" if is_void else f"    {kind} result;\n".replace("* result", "*result")
        pointer = declaration(kind, "(*next)", values).replace(" (*next)(", " (*next)(")
        parts.append(
            f"{declaration(kind, name, values)}\n{{\n"
            f"    void *arguments[] = {{{arguments(values)}}};\n    {pointer};\n    recorder_call call;\n{result}"
            f'    recorder_find("{name}", &next, sizeof next);\n'
            f"    recorder_enter(&call, &layout_functions[{k}], arguments);\n"
            f"    {'' if is_void else 'result = '}next({passed(values)});\n"
            f"    recorder_leave(&call, {'NULL' if is_void else '&result'});\n"
            f"{'' if is_void else '    return result;' + chr(10)}}}\n")
    for kind, name, inside, _ in h.io:
        values = [Value(k, n) for k, n in parameters(inside)]
        is_void = kind == "void"
        result = "" if is_void else f"    {kind} result;\n".replace("* result", "*result")
        parts.append(
            f"{declaration(kind, name, values)}\n{{\n    {declaration(kind, '(*next)', values)};\n{result}"
            f'    recorder_find("{name}", &next, sizeof next);\n    recorder_note("{name}", 0);\n'
            f"    {'' if is_void else 'result = '}next({passed(values)});\n"
            f'    recorder_note("{name}", 1);\n'
            f"{'' if is_void else '    return result;' + chr(10)}}}\n")
    trampolines = []
    for k, (name, (kind, values, _)) in enumerate(h.callbacks.items()):
        is_void = kind == "void"
        parts.append(
            f"static {declaration(kind, f'callback_{k}', values)}\n{{\n"
            f"    recorder_callback *callback = p0;\n    void *arguments[] = {{{arguments(values)}}};\n"
            f"    recorder_answer answer;\n    {name} host;\n"
            f"{'' if is_void else f'    {kind} result;{chr(10)}'}"
            f"    recorder_callback_enter(&answer, callback, arguments);\n"
            f"    recorder_get(callback, &host, sizeof host);\n"
            f"    {'' if is_void else 'result = '}host({', '.join(['callback->ctx'] + [f'p{i}' for i in range(1, len(values))])});\n"
            f"    recorder_callback_leave(&answer, {'NULL' if is_void else '&result'});\n"
            f"{'' if is_void else '    return result;' + chr(10)}}}\n")
        trampolines.append(f"    (recorder_function)callback_{k},")
    parts.append("const recorder_function recorder_callbacks[] = {\n" + "\n".join(trampolines) + "\n};")
    return "\n".join(parts)


def played(h):
    """played.c: each public function called with arguments at addresses, and callbacks that answer."""
    parts = [HEAD + '#include "player.h"\n#include "se3d/se3d.h"\n']
    for k, (kind, _, values) in enumerate(h.functions):
        passed_on = ", ".join(f"*({v.type}{'' if v.type.endswith('*') else ' '}{'*' if v.dims else ''}*)a[{i}]"
                              if not v.type.endswith("*") or v.dims else f"*({v.type}*)a[{i}]"
                              for i, v in enumerate(values))
        store = "" if kind == "void" else f"*({kind} *)result = "
        parts.append(f"static void call_{k}(void *const *a, void *result)\n{{\n    (void)a;\n    (void)result;\n"
                     f"    {store}{h.functions[k][1]}({passed_on});\n}}\n")
    for k, (name, (kind, values, _)) in enumerate(h.callbacks.items()):
        is_void = kind == "void"
        parts.append(
            f"static {declaration(kind, f'answer_{k}', values)}\n{{\n"
            f"    void *arguments[] = {{{arguments(values)}}};\n"
            f"{'' if is_void else f'    {kind} result = 0;{chr(10)}'}"
            f"    player_answer(p0, arguments, {'NULL' if is_void else '&result'});\n"
            f"{'' if is_void else '    return result;' + chr(10)}}}\n")
    rows = [f"    call_{k}," for k in range(len(h.functions))]
    parts.append("const player_call player_calls[] = {\n" + "\n".join(rows) + "\n};")
    rows = [f"    (player_function)answer_{k}," for k in range(len(h.callbacks))]
    parts.append("const player_function player_answers[] = {\n" + "\n".join(rows) + "\n};")
    return "\n".join(parts)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, metavar="FOLDER")
    folder = parser.parse_args().folder
    layouts = Layouts()
    try:
        tables = layouts.tables()
    except Problem as problem:
        sys.exit(f"record_calls.py: {problem}")
    h = layouts.headers
    if folder:
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in (("layouts.c", tables), ("recorded.c", recorded(h)), ("played.c", played(h))):
            (folder / name).write_text(text + "\n")
    print(f"record: {len(h.functions)} functions, {len(h.callbacks)} callbacks, {len(h.structs)} structures, "
          f"{len(h.io)} functions of libse3d-io noted")
    return 0 if h.functions else 1


if __name__ == "__main__":
    sys.exit(main())
