"""No number depends on the system's language: all are read and written by src/base/number.h, or written by fmt.

Usage: numbers_test.py, from the project's folder.
"""
import pathlib
import re
import unittest

#: Calls that read or write numbers in the current language, or set this language.
FORBIDDEN = {
    "the C library's readers": r"\b(?:std::)?(?:strto(?:d|f|ld|l|ll|ul|ull|imax|umax)|ato(?:f|i|l|ll)|v?f?s?scanf|wcsto\w+)\s*\(",
    "C++'s readers": r"\bstd::sto(?:d|f|ld|i|l|ll|ul|ull)\b",
    "C++'s writers": r"\bstd::to_w?string\b",
    "a language for streams": r"\bimbue\b|\bstd::locale\b|\bput_money\b",
    "what fmt writes in the language": r"\{\w*:[^{}\"\s]*[LaA]\}",
    "a language for the process": r"\bsetlocale\s*\(",
    "Qt's way of the language": r"%L\d|\bto(?:CurrencyString|LocalString)\b|QLocale\(\)\s*\.\s*(?:toString\((?!.*\"d MMMM)|to(?:Double|Int|Float))",
    "Qt's field for numbers": r"\bnew Q(?:Double)?SpinBox\b|\bQDoubleValidator\b",
}
#: Files that may use them, and why.
ALLOWED = {
    ("app/gui/application.cpp", "a language for the process"): "takes the language of numbers back that Qt put in force",
}
#: Forbidden in the product, but not in its tests, which may print what they measured.
OF_THE_PRODUCT = {
    "numbers by printf": r"printf\s*\([^;]*%[-+ #0-9.*]*[aefgAEFG]",
    "C++'s readers of reals": r">>\s*\w+(?:\.(?:x|y|z|w)\(\)|\[\d\])",
}


def sources():
    for folder in ("src", "app", "bench", "python/native"):
        for path in sorted(pathlib.Path(folder).rglob("*")):
            if path.suffix in (".h", ".cpp"):
                yield str(path), path.read_text()


class Numbers(unittest.TestCase):
    def test_do_not_depend_on_the_language(self):
        found = set()
        for path, text in sources():
            text = re.sub(r"//[^\n]*", "", text)
            product = not {"test", "soak"} & set(pathlib.Path(path).parts)
            for what, pattern in {**FORBIDDEN, **(OF_THE_PRODUCT if product else {})}.items():
                for match in re.finditer(pattern, text):
                    found.add((path, what))
                    with self.subTest(f"{path}:{text[:match.start()].count(chr(10)) + 1}: {match[0]}"):
                        self.assertIn((path, what), ALLOWED, f"{what}: use base/number.h")
        self.assertEqual(found, set(ALLOWED), "what is allowed is there")

    def test_the_patterns_find_what_they_name(self):
        for text in ("std::strtod(a, &b)", "atoi(word)", "sscanf(text, \"%d\", &n)", "std::stod(a)", "std::to_string(1.5)",
                     "snprintf(out, size, \"%.3f\", x)", "out.imbue(std::locale(\"\"))", "fmt::format(\"{:.3L}\", x)",
                     "QString(\"%L1\").arg(x)", "new QDoubleSpinBox", "QLocale().toString(1.5)", "setlocale(LC_ALL, \"\")"):
            with self.subTest(text):
                self.assertTrue(any(re.search(pattern, text) for pattern in {**FORBIDDEN, **OF_THE_PRODUCT}.values()))


if __name__ == "__main__":
    unittest.main()
