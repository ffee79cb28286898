# SPDX-License-Identifier: BSD-3-Clause
"""Formulas of the theory pages are typeset as what they mean, whole, and names of the code are not."""
import html
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree as ElementTree

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/site"))
sys.dont_write_bytecode = True
import formulas  # noqa: E402

PAGES = sorted((ROOT / "docs/theory").glob("*.md"))


def show(node):
    """MathML in one line: a_{b}^{c} scripts, {a|b} fractions, [a & b; c & d] tables, (a∼) accents."""
    parts = [show(child) for child in node]
    text = (node.text or "") + "".join(parts)
    if node.tag == "mspace":
        return " "
    if node.tag in ("msub", "munder"):
        return f"{parts[0]}_{{{parts[1]}}}"
    if node.tag == "msup":
        return f"{parts[0]}^{{{parts[1]}}}"
    if node.tag == "msubsup":
        return f"{parts[0]}_{{{parts[1]}}}^{{{parts[2]}}}"
    if node.tag == "mfrac":
        return f"{{{parts[0]}|{parts[1]}}}"
    if node.tag == "mover":
        return f"({parts[0]}{parts[1]})"
    if node.tag == "msqrt":
        return f"√({text})"
    if node.tag == "mtable":
        return "; ".join(parts)
    return " & ".join(parts) if node.tag == "mtr" else text


def typeset(text):
    return show(ElementTree.fromstring(formulas.convert(text, True)))


def find_formulas():
    """(page, text, is it a block) of all that is typeset."""
    for page in PAGES:
        text = re.sub(r"(?ms)^```.*?^```", "", page.read_text())
        for block in re.findall(r"(?m)(?:^ {4}.*\n(?:\n(?= {4}))?)+", text):
            yield page.name, block, True
        for word in re.findall(r"`([^`]+)`", re.sub(r"(?m)^ {4}.*\n", "", text)):
            if formulas.is_formula(word):
                yield page.name, word, False


def list_signs(text):
    """Letters and figures in the order of reading; signs that have no letters of their own are left out."""
    for word, sign in formulas.GREEK.items():
        text = text.replace(sign, word)
    text = re.sub(r"[^0-9A-Za-z]", "", re.sub(r"(?<=[A-Za-z])d?dot(?![a-z])", "", text))
    return re.sub(r"sqrt|tilde|sum|int|x", "", text.replace("Tinv", "T1"))


class Formulas(unittest.TestCase):
    def test_notation_is_typeset_as_what_it_means(self):
        for text, expected in {
                "M vdot + Phi_q^T lambda = Q": "M (v˙)+Φ_{q}^{T} λ=Q",
                "p' = 1/2 G(p)^T w": "p^{′}={1|2} G(p)^{T} w",
                "kn/2 (l - L)^2": "{k_{n}|2} (l−L)^{2}",
                "(1 - cos t)/t^2": "{1−cos t|t^{2}}",
                "(a - b)/(c + d)(e)": "{a−b|c+d}(e)",
                "f / 2 C_x": "f/2 C_{x}",
                "h^(s+1) + 2^-52": "h^{s+1}+2^{−52}",
                "A_i (w_i x (w_i x s_i))": "A_{i} (w_{i}×(w_{i}×s_{i}))",
                "1/2 x x m + c x x (x x m)": "{1|2} x×m+c x×(x×m)",
                "K x + c": "K x+c",
                "d.(u x v) - 2 ddot.ddot": "d⋅(u×v)−2 (d˙)⋅(d˙)",
                "pddot": "(p¨)", "dlambda": "dλ", "dvdot": "d(v˙)", "e0^2": "e_{0}^{2}",
                "1/m* + sqrt(m* s)": "{1|m^{*}}+√(m^{*} s)",
                "tilde(a) b": "(a∼) b", "-n^ g": "−(n^) g",
                "sum_(j<i) N_ij u_j": "∑_{j<i} N_{ij} u_{j}",
                "h_{k-1} m_{k-1}": "h_{k−1} m_{k−1}", "s_k,qq u": "s_{k,qq} u", "K(a_i,v)": "K(a_{i},v)",
                "|F| <= mu |c - |d||": "|F|≤μ |c−|d||",
                "[M p; p^T 0] [0; nu - Phi_q v]": "[M & p; p^{T} & 0] [0; ν−Φ_{q} v]",
                "k >= 1e-4 2.5e6": "k≥10^{−4} 2.5·10^{6}",
                "sum over the bodies of w": "∑ over the bodies of w",
                "mu_max - F_s": "μ_{max}−F_{s}", "A -> A exp(dpi)": "A→A exp(dπ)"}.items():
            self.assertEqual(typeset(text), expected, text)

    def test_brackets_over_lines_are_matrices(self):
        block = formulas.make_block("[M + K   C^T] [dv    ]   [-g ]        G = 1\n"
                                    "[C       0  ] [lambda] = [ nu]")
        self.assertEqual(show(ElementTree.fromstring(block)), "[M+K & C^{T}; C & 0][dv; λ]=[−g; ν] G=1")

    def test_columns_of_lines_stay_below_each_other(self):
        block = ElementTree.fromstring(formulas.make_block("w     = 2 G    p = 1\nwdot  = 2      a rule of the house"))
        places = [(cell.get("style"), show(cell)) for cell in block]
        self.assertEqual([style.split("/")[0] for style, _ in places],
                         [f"grid-row:{line};grid-column:{column}" for line in (1, 2) for column in (1, 2, 3)])
        self.assertEqual(places[5][1], "a rule of the house")

    def test_names_of_the_code_are_not_typeset(self):
        for text in ("hht", "generalized_alpha", "dop853", "lib/force/tyre.c", "order: 8", "if(t < 1, 0, t - 1)", "at",
                     "se3d_solver_step(h)", "wheel_load", "contact: {audit: true}", "dp1_a dp1_b", "SE3D_ERR_STATE", "16"):
            self.assertFalse(formulas.is_formula(text), text)
        for text in ("h", "Phi_q", "qddot", "e0", "Fn", "p -> -p", "h <= 1", "m*", "n^", "exp(-e t)", "axis_i"):
            self.assertTrue(formulas.is_formula(text), text)
        page = "<p><code>hht</code> takes <code>h &lt;= 1</code></p><pre><code>a = b\n</code></pre>"
        page = formulas.typeset(page)
        self.assertIn("<code>hht</code>", page)
        self.assertEqual(page.count("<math"), 2)

    def test_every_formula_of_the_pages_is_whole(self):
        count = 0
        for page, text, is_block in find_formulas():
            made = formulas.make_block(html.unescape(text)) if is_block else formulas.convert(text)
            root = ElementTree.fromstring(made)
            if not (is_block and len(formulas.find_matrices(text.splitlines()))):
                source = re.sub(r"\b(\d[\d.]*)e([-+]?\d)", lambda at: at[1].removesuffix("1") + "10" + at[2], text)
                made = "".join(root.itertext()).replace("1e-", "10")
                self.assertEqual(list_signs(made), list_signs(source), f"{page}: {text}")
            count += 1
        self.assertGreater(count, 1400)

    def test_brackets_of_matrices_stand_in_columns(self):
        for page, text, is_block in find_formulas():
            lines = [line.strip() for line in text.splitlines()] if is_block else []
            for first, second in zip(lines, lines[1:]):
                if first.startswith("[") and second.startswith("[") and ";" not in first and "(a, alpha)" not in second:
                    self.assertEqual(formulas.find_brackets(first), formulas.find_brackets(second), f"{page}: {text}")


if __name__ == "__main__":
    unittest.main()
