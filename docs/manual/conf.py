"""Configures Sphinx for the manual; docs/manual/make/make.py gives its input."""

project = "Dihaptic"
copyright = "the authors of Dihaptic"
html_title = "Dihaptic"
extensions = ["myst_parser", "sphinx_copybutton"]
myst_heading_anchors = 3
html_theme = "furo"
html_static_path = ["look"]
html_css_files = ["manual.css"]
html_show_sourcelink = False
html_copy_source = False
html_show_sphinx = False
# the output of commands must not be copied
copybutton_selector = "div:not(.highlight-text):not(.highlight-none) > div.highlight > pre"
highlight_language = "none"

