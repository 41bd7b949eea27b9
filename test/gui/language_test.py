"""The window in another language: a translation beside the program is found by the system's language."""
import os
import pathlib
import shutil
import struct
import time
import unittest

import window

import soak

MENUS = "dihaptic::gui::OperatorWindow"


def hash_of(source):
    """ELF's hash, of the words by which a text is looked up."""
    value = 0
    for byte in source.encode():
        value = (value << 4) + byte
        high = value & 0xf0000000
        value = (value ^ high >> 24) & ~high & 0xffffffff
    return value or 1


def translation(texts):
    """A .qm file, as lrelease writes it, of texts by context and source."""
    messages, places = b"", []
    for (context, source), text in texts.items():
        places.append((hash_of(source), len(messages)))
        for tag, part in (3, text.encode("utf-16-be")), (6, source.encode()), (7, context.encode()):
            messages += struct.pack(">BI", tag, len(part)) + part
        messages += b"\1"
    table = b"".join(struct.pack(">II", *place) for place in sorted(places))
    return bytes.fromhex("3cb86418caef9c95cd211cbf60a1bddd") + b"".join(
        struct.pack(">BI", tag, len(part)) + part for tag, part in ((0x42, table), (0x69, messages)))


class Language(window.Window):
    def setUp(self):
        super().setUp()
        folder = pathlib.Path(self.folder.name, "program")
        (folder / "translations").mkdir(parents=True)
        for name in ("dihaptic", "dihaptic-gui"):
            shutil.copy(pathlib.Path(window.PROGRAM).parent / name, folder / name)
        (folder / "translations/dihaptic_de.qm").write_bytes(translation({
            (MENUS, "&File"): "&Datei",
            (MENUS, "Open a scene or an experiment"): "Eine Szene oder einen Versuch laden",
            (MENUS, "Press F5 to start"): "F5 beginnt",
            ("QObject", "&Handles"): "&Griffe"}))
        program = window.PROGRAM
        self.addCleanup(lambda: setattr(window, "PROGRAM", program))
        window.PROGRAM = str(folder / "dihaptic")
        for name in ("LC_ALL", "LC_MESSAGES"):
            self.environment.pop(name, None)

    def dialog(self, title):
        self.key("ctrl+o")
        self.wait("the dialog", lambda: self.xdotool("search", "--onlyvisible", "--name", title))
        time.sleep(0.5)

    def test_the_systems_language_is_spoken(self):
        self.environment.update(LANG="de_DE.UTF-8", LANGUAGE="de")
        self.open()
        self.key("alt+v")
        time.sleep(0.5)
        self.screenshot("language")
        self.key("Escape")
        self.dialog("^Eine Szene oder")
        self.screenshot("language-dialog")

    @soak.alone
    def test_without_a_translation_it_is_english(self):
        self.environment.update(LANG="fr_FR.UTF-8", LANGUAGE="fr")
        self.open()
        self.dialog("^Open a scene or an experiment")


if __name__ == "__main__":
    unittest.main()
