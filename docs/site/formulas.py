# SPDX-License-Identifier: BSD-3-Clause
"""Typeset the formulas of the theory pages: from the notation of the sources (docs/theory/README.md),
which stays readable as text, to MathML, which browsers show without a script.

    convert("M vdot + Phi_q^T lambda = Q")      MathML of one formula
    is_formula("generalized_alpha")             or a name in the code?
    typeset(html)                               a page with its formulas typeset

Factors stand beside each other, `x` and `.` between factors are products of vectors, `a/b` without
spaces is a fraction of what stands next to it, `m*` has a star, `n^` a hat, `[a b; c d]` is a matrix."""
import html
import re

GREEK = dict(zip(
    "alpha beta gamma delta eps zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi psi omega "
    "Gamma Delta Phi Psi Omega".split(), "αβγδεζηθκλμνξπρστφψωΓΔΦΨΩ"))
SYMBOLS = {"<=": "≤", ">=": "≥", "!=": "≠", "->": "→", "<-": "←", "+-": "±", "-+": "∓", "...": "…", "..": "…",
           "-": "−", "~": "∼", "*": "·", ".": "⋅", "+=": "+=", "-=": "−=", "*=": "·="}
FUNCTIONS = set("sin cos tan atan atan2 cot tanh exp ln log max min abs tr diag clamp argmin sqrt tilde sum int".split())
PAIRS = set("kn ks kb kt vn vt Fn Ft Fc Fx Fy Fz Mx My Mz Mr Kr Dr".split())
SHORT_WORDS = set("of as at is by it to if or no on in an do".split())
TOKEN = re.compile(r"""
    (?P<space>\s+)
  | (?P<number>\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![A-Za-z]\w)|\.\d+)
  | (?P<name>[A-Za-z][A-Za-z0-9]*(?:_(?:[A-Za-z0-9]+|\{[^}]*\}|\([^)]*\)))*(?:(?:(?<=_\w)|(?<=_\w\w)),[a-z]{1,2}(?=[\s^]|$))?)
  | (?P<mark>'+)
  | (?P<operator>\.\.\.|\.\.|<=|>=|!=|->|<-|\+-|-\+|\+=|-=|\*=|[-+*/=<>~.,:;!^_])
  | (?P<open>[(\[{])
  | (?P<close>[)\]}])
  | (?P<bar>\|)
  | (?P<other>.)""", re.X)


def tag(name, *parts, **attributes):
    words = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f"<{name}{words}>{''.join(parts)}</{name}>"


def row(parts):
    return parts[0] if len(parts) == 1 else tag("mrow", *parts)


def operator(text, **attributes):
    return tag("mo", html.escape(SYMBOLS.get(text, text)), **attributes)


def is_word(name):
    """A word of English or a name that is spelled out, not a symbol."""
    base = name.split("_")[0].rstrip("0123456789")
    return spell(base) is None and base not in FUNCTIONS


def spell(base):
    """The symbol of a name without subscripts and figures: a letter, Greek, with dots, a difference."""
    if base in GREEK:
        return tag("mi", GREEK[base])
    if len(base) == 1:
        return tag("mi", base)
    if base in PAIRS:
        return tag("msub", tag("mi", base[0]), tag("mi", base[1]))
    if base == "Tinv":
        return tag("msup", tag("mi", "T"), row([operator("-"), tag("mn", "1")]))
    dots = re.fullmatch(r"(.+?)(d?dot)", base)
    if dots and spell(dots[1]):
        if len(dots[1]) > 1 and dots[1][0] == "d" and dots[1] not in GREEK:
            return row([tag("mi", "d"), spell(dots[1][1:] + dots[2])])
        return tag("mover", spell(dots[1]), operator("¨" if dots[2] == "ddot" else "˙"), accent="true")
    if base[0] == "d" and base not in SHORT_WORDS and (len(base) == 2 or base[1:] in GREEK):
        return row([tag("mi", "d"), spell(base[1:])])
    return None


def script(text):
    """A subscript: letters of an index, a symbol, a word, or a formula in braces."""
    if text[0] in "{(":
        return Reader(text[1:-1], True).read_all()
    if text.isdigit():
        return tag("mn", text)
    if spell(text):
        return spell(text)
    if len(text) == 2 and text.isalpha():
        return row([tag("mi", text[0]), tag("mi", text[1])])
    if re.fullmatch(r"[a-z]\d", text):
        return row([tag("mi", text[0]), tag("mn", text[1])])
    return tag("mtext", text)


class Reader:
    """One formula, read from the left."""

    def __init__(self, text, small=False):
        self.tokens = [(match.lastgroup, match.group()) for match in TOKEN.finditer(text.strip())]
        self.place = 0
        self.small = small
        self.bars = 0

    def peek(self, ahead=0):
        place = self.place + ahead
        return self.tokens[place] if place < len(self.tokens) else ("end", "")

    def take(self):
        token = self.peek()
        self.place += 1
        return token

    def read_all(self):
        parts = []
        while self.peek()[0] != "end":
            parts += self.read_row()
            if self.peek()[0] in ("close", "bar"):
                parts.append(operator(self.take()[1]))
        return row(parts)

    def read_row(self):
        """Terms up to what closes this row."""
        parts, is_operand, spaces = [], False, ""
        while True:
            kind, text = self.peek()
            if kind in ("end", "close") or (kind == "bar" and self.bars and is_operand):
                return parts
            if kind == "space":
                spaces = self.take()[1]
                continue
            if kind == "operator" and text not in ("^", "_"):
                self.take()
                parts.append(self.make_operator(text, is_operand))
                is_operand = False
            elif self.is_cross(is_operand):
                self.take()
                parts.append(tag("mo", "×"))
                is_operand = False
            else:
                if is_operand and spaces:
                    parts.append(tag("mspace", width="1.5em" if len(spaces) > 1 else ".2em"))
                parts.append(self.read_factor())
                is_operand = True
            spaces = ""

    def make_operator(self, text, is_operand):
        if text in "+-" and not is_operand:
            return operator(text, form="prefix")
        if text in (",", ";", ":"):
            space = "1.5em" if len(self.peek()[1]) > 1 and self.peek()[0] == "space" else ".3em"
            return operator(text, lspace="0", rspace=space)
        return operator(text)

    def is_cross(self, is_operand):
        """`x` between two factors; of two in a row the first is a variable."""
        if self.peek() != ("name", "x") or not is_operand or self.peek(1)[0] != "space":
            return False
        kind, text = self.peek(2)
        return kind in ("open", "number") or (kind == "name" and not (text == "x" and self.peek(3)[0] == "space" and
                                                                      self.peek(4)[0] in ("name", "open")))

    def read_factor(self):
        """What a fraction is made of, or one atom."""
        left = self.read_atom()
        while self.peek() == ("operator", "/") and self.peek(1)[0] not in ("space", "end") and not self.small:
            self.take()
            sign = operator(self.take()[1], form="prefix") if self.peek() == ("operator", "-") else ""
            left = tag("mfrac", self.bare(left), row([sign, self.bare(self.read_atom())]) if sign else
                       self.bare(self.read_atom()))
        return left

    @staticmethod
    def bare(part):
        """Without parentheses around the whole, which a fraction does not need."""
        return re.sub(r'^<mrow class="fence">(<mo[^>]*>)\((</mo>)(.*)<mo[^>]*>\)</mo></mrow>$', r"<mrow>\3</mrow>", part,
                      flags=re.S)

    def read_atom(self):
        kind, text = self.take()
        if kind == "number":
            return self.add_scripts(self.make_number(text), None)
        if kind == "open":
            return self.add_scripts(self.read_fence(text, 0), None)
        if kind == "bar":
            return self.add_scripts(self.read_bars(), None)
        if kind == "name":
            return self.read_name(text)
        return operator(text)

    @staticmethod
    def make_number(text):
        match = re.fullmatch(r"([\d.]+)e([-+]?)(\d+)", text)
        if not match:
            return tag("mn", text)
        sign = [operator("-")] if match[2] == "-" else []
        power = tag("msup", tag("mn", "10"), row(sign + [tag("mn", match[3])]))
        return power if match[1] == "1" else row([tag("mn", match[1]), tag("mo", "·"), power])

    def read_name(self, text):
        text, _, derivative = text.partition(",")
        base, *scripts = re.findall(r"(?:^|_)(\{[^}]*\}|\([^)]*\)|[A-Za-z0-9]+)", text)
        stem = base.rstrip("0123456789") if base != "atan2" else base
        symbol = spell(stem)
        if symbol is None and stem not in FUNCTIONS:
            if not scripts or len(stem) > 2 and any(len(part) > 2 and part[0] not in "{(" and part not in GREEK
                                                    for part in scripts):
                return self.add_scripts(tag("mi", text, mathvariant="normal"), None)
            symbol = tag("mi", stem, mathvariant="normal")
        if len(base) > len(stem):
            scripts.insert(0, base[len(stem):])
        if stem in ("sqrt", "tilde") and self.peek()[0] in ("open", "name", "space"):
            return self.read_function(stem)
        lower = [script(part) for part in scripts]
        if derivative:
            lower += [tag("mo", ","), script(derivative)]
        if stem in FUNCTIONS:
            big = {"sum": "∑", "int": "∫"}.get(stem)
            symbol = tag("mo", big) if big else tag("mi", base)
            if lower and stem in ("sum", "max", "min"):
                return tag("munder", symbol, row(lower))
        part = self.add_scripts(symbol, row(lower) if lower else None)
        if self.peek()[0] == "open" and self.peek()[1] == "(":
            part = row([part, self.read_fence(self.take()[1], 0)])
            return self.add_scripts(part, None)
        return part

    def read_function(self, stem):
        if self.peek()[0] == "space":
            self.take()
        inner = self.read_fence(self.take()[1], 1) if self.peek()[0] == "open" else self.read_atom()
        if stem == "sqrt":
            return self.add_scripts(tag("msqrt", inner), None)
        return self.add_scripts(tag("mover", inner, operator("~", stretchy="true"), accent="true"), None)

    def read_fence(self, text, is_bare):
        """To the bracket that closes; with semicolons in square ones a matrix."""
        depth, end = 1, self.place
        while depth and end < len(self.tokens):
            depth += {"open": 1, "close": -1}.get(self.tokens[end][0], 0)
            end += 1
        inner = self.tokens[self.place:end - (depth == 0)]
        if text == "[" and ("operator", ";") in inner:
            self.place = end
            return fence(make_matrix("".join(word for _, word in inner), self.small), "[", "]")
        bars, self.bars = self.bars, 0
        parts = self.read_row()
        self.bars = bars
        close = self.take()[1] if self.peek()[0] == "close" else ""
        if is_bare and (text, close) == ("(", ")"):
            return row(parts) if parts else tag("mrow")
        return fence(row(parts) if parts else "", text, close)

    def read_bars(self):
        start, self.bars = self.place, self.bars + 1
        parts = self.read_row()
        self.bars -= 1
        if self.peek()[0] == "bar":
            self.take()
            return tag("mrow", tag("mo", "|", form="prefix"), *parts, tag("mo", "|", form="postfix"))
        self.place = start
        return operator("|")

    def add_scripts(self, part, lower):
        upper = []
        while True:
            kind, text = self.peek()
            if kind == "mark":
                upper.append(operator({1: "′", 2: "″"}.get(len(self.take()[1]), "‴")))
            elif (kind, text) == ("operator", "*") and self.peek(1)[0] != "number" and not (
                    self.peek(1)[0] == "name" and not self.peek(1)[1].startswith("_")):
                if self.peek(-1)[0] == "space":
                    break
                self.take()
                upper.append(tag("mo", "*", lspace="0", rspace="0"))
            elif (kind, text) == ("operator", "^"):
                self.take()
                if self.peek()[0] in ("space", "end", "close") or self.peek() == ("operator", "/"):
                    part = tag("mover", part, operator("^"), accent="true")
                else:
                    upper.append(self.read_power())
            elif (kind, text) == ("operator", "_") and lower is None and self.peek(1)[0] in ("name", "number"):
                self.take()
                lower = script(self.take()[1])
            else:
                break
        if lower and upper:
            return tag("msubsup", part, lower, row(upper))
        if lower:
            return tag("msub", part, lower)
        return tag("msup", part, row(upper)) if upper else part

    def read_power(self):
        sign = []
        if self.peek() == ("operator", "-"):
            self.take()
            sign = [operator("-", form="prefix")]
        kind, text = self.take()
        if kind == "open":
            small, self.small = self.small, True
            inner = self.read_fence(text, 1)
            self.small = small
        elif kind == "number":
            inner = tag("mn", text)
        else:
            inner = script(text) if kind == "name" else operator(text)
        return row(sign + [inner])


def fence(inner, left, right):
    grows = {} if re.search("<(mfrac|mtable|munder|msqrt)", inner) else {"stretchy": "false"}
    return tag("mrow", operator(left, **grows), inner, operator(right, **grows) if right else "",
               **{"class": "fence"})


def split(text, pattern):
    """At what matches the pattern outside brackets."""
    parts, depth, start = [], 0, 0
    for place, letter in enumerate(text):
        depth += (letter in "([{") - (letter in ")]}")
        match = re.compile(pattern).match(text, place) if not depth and place >= start else None
        if match:
            parts.append(text[start:place])
            start = match.end()
    return [part for part in (word.strip() for word in parts + [text[start:]]) if part]


def make_matrix(text, small=False):
    rows = split(text, ";")
    if any("," in re.sub(r"\([^)]*\)", "", line) for line in rows):
        cells = [split(line, ",") for line in rows]
    else:
        first = split(rows[0], r"\s+")
        cells = [[line] if len(first) == 1 else split(line, r"\s\s+") if re.search(r"\S\s\s+\S", line) else
                 split(line, r"\s+") for line in rows]
    return table([[Reader(cell, small).read_all() for cell in line] for line in cells])


def table(rows):
    return tag("mtable", *(tag("mtr", *(tag("mtd", cell) for cell in cells)) for cells in rows))


def convert(text, display=False):
    """MathML of a formula; what was written stays as its name for those who hear or copy it."""
    text = " ".join(text.split()) if not display else text
    return wrap(Reader(text, not display).read_all(), text, display)


def wrap(inner, text, display):
    words = {"display": "inline", "alttext": html.escape(" ".join(text.split()), quote=True)}
    return tag("math", tag("mstyle", inner, displaystyle="true") if display else inner, **words)


# What stands in the text: symbols are typeset, names of the code are not.

CODE = re.compile(r"""[:"$#]|\b\w+\.(c|h|inc|py|md|yaml|tir|svg)\b|\bif\(|\w\*\w|/\*|\w/$|^[a-z]{3,}/[a-z]|'|=[a-z]{3}
                      |SE3D_|^se3d|[a-z]{5,}\.[a-z]{5,}|\]\[|^(cd|dp\d|vtk)(\b|_)|^[A-Z_]{2,}( = [a-z]|\.\.)|^!""", re.X)


def is_formula(text):
    """Has the text a formula or a symbol? Names of methods, keys and files are code."""
    text = " ".join(text.split())
    if not text or CODE.search(re.sub(r"(?<=[\w)])'+", "", text)) and not text.startswith("V stress", 2):
        return False
    if re.fullmatch(r"[A-Za-z]\w*", text):
        base, _, index = text.partition("_")
        base = base.rstrip("0123456789")
        return base not in FUNCTIONS and (spell(base) is not None or len(index) == 1) and (len(index) < 4 or index in GREEK)
    if re.fullmatch(r"[-+]?[\d.]+", text):
        return False
    if any(is_word(name) for name in re.findall(r"[A-Za-z]\w*", text)):
        return bool(re.search(r" [-+=<>*/~.] |<=|>=|^-\w|\w\(|\^", text)) and not re.search(
            r"[A-Z]{3}\w* = '|\w=\w|[a-z] METHOD", text)
    return True


# Blocks: lines whose parts are set below each other as in the source; brackets over several lines are matrices.

def find_matrices(lines):
    """Groups of lines with brackets in the same columns: [first, last, columns of the brackets]."""
    groups, number = [], 0
    while number < len(lines):
        last, columns = number, None
        while last + 1 < len(lines):
            shared = [pair for pair in find_brackets(lines[number]) if pair in find_brackets(lines[last + 1])]
            shared = [pair for pair in shared if columns is None or pair in columns]
            if not shared:
                break
            last, columns = last + 1, shared
        if columns:
            groups.append((number, last, columns))
        number = last + 1
    return groups


def find_brackets(line):
    pairs, start = [], None
    for place, letter in enumerate(line):
        if letter == "[" and start is None:
            start = place
        elif letter == "]" and start is not None:
            pairs.append((start, place))
            start = None
    return pairs


def make_group(lines, columns):
    """Matrices of several lines with what stands between them in any of the lines."""
    parts, place, tail = [], 0, []
    for left, right in columns:
        between = [line[place:left].strip() for line in lines]
        parts += [Reader(text).read_all() for text in between if text]
        cells = [line[left + 1:right] for line in lines]
        starts = sorted({match.end() for cell in cells for match in re.finditer(r"^\s*|\s\s+", cell)
                         if match.end() < len(cell)})
        starts = [start for start in starts if start == 0 or all(
            cell[start - 1:start].strip() == "" for cell in cells)]
        starts = starts or [0]
        rows = [[cell[start:end].strip() for start, end in zip([0] + starts[1:], starts[1:] + [None])] for cell in cells]
        rows = [[Reader(cell).read_all() if cell else tag("mrow") for cell in cells] for cells in rows]
        parts.append(fence(table(rows), "[", "]"))
        place = right + 1
    for line in lines:
        text = line[place:]
        if text.strip():
            tail.append((tag("mspace", width="2em") if text.startswith("   ") else "") + Reader(text).read_all())
    if len(tail) == 1:
        parts += tail
    elif tail:
        parts.append(table([[part] for part in tail]))
    return wrap(row(parts), " ".join(lines), True)


def find_starts(lines):
    """Columns at which parts of lines begin that are set below each other."""
    starts = {0}
    for line in lines:
        depth = 0
        for place, letter in enumerate(line):
            depth += (letter in "([{") - (letter in ")]}")
            if depth == 0 and line[:place].endswith("  ") and letter != " ":
                starts.add(place)
    return sorted(starts)


def cut(line, starts):
    """Parts of a line by column: {column: text}."""
    depth, begin, parts = 0, 0, {}
    for place, letter in enumerate(line + " "):
        if place in starts and place and depth == 0 and (line[:place].endswith("  ") and letter != " " or
                                                         line[place - 1] == " " and letter in "=<>~"):
            if line[begin:place].strip():
                parts[begin] = line[begin:place].strip()
            begin = place
        depth += (letter in "([{") - (letter in ")]}")
    if line[begin:].strip():
        parts[begin] = line[begin:].strip()
    return parts


def make_part(text):
    """A part of a line: a formula, or a remark if it is mostly words."""
    names = re.findall(r"[A-Za-z]\w*", text)
    words = [name for name in names if is_word(name)]
    if len(words) > 2 and 2 * len(words) > len(names) and not re.search(r"[=^+]|\w\(", text):
        return tag("span", html.escape(text))
    return convert(text, True)


def make_block(text):
    lines = [line.rstrip() for line in text.rstrip("\n").splitlines()]
    margin = min(len(line) - len(line.lstrip()) for line in lines if line)
    lines = [line[margin:] for line in lines]
    groups = {first: (last, columns) for first, last, columns in find_matrices(lines)}
    single = [line for number, line in enumerate(lines)
              if not any(first <= number <= last for first, (last, _) in groups.items())]
    starts = find_starts(single)
    rows, number = [], 0
    while number < len(lines):
        if number in groups:
            last, columns = groups[number]
            rows.append({0: make_group(lines[number:last + 1], columns)})
            number = last + 1
            continue
        rows.append({start: make_part(part) for start, part in cut(lines[number], starts).items()})
        number += 1
    order = sorted({start for parts in rows for start in parts})
    cells = []
    for line, parts in enumerate(rows, 1):
        for start, part in parts.items():
            later = [other for other in parts if other > start]
            end = order.index(min(later)) + 1 if later else len(order) + 1
            place = f"grid-row:{line};grid-column:{order.index(start) + 1}/{end}"
            cells.append(f'<div style="{place}">{part}</div>')
    return f'<div class="formulas">{"".join(cells)}</div>'


def typeset(page):
    """A page of HTML with its formulas typeset: indented blocks, and what in the text is no name of the code."""
    def change(match):
        text = html.unescape(match[2] if match[1] is None else match[1])
        if match[1] is not None:
            return make_block(text)
        return convert(text) if is_formula(text) else match[0]

    return re.sub(r"<pre><code>(.*?)</code></pre>|<code>(.*?)</code>", change, page, flags=re.S)
