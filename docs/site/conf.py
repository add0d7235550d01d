"""How Sphinx makes the site; docs/site/build.py runs it. Pages need no network and no script of their own."""

from pathlib import Path

HERE = Path(__file__).resolve().parent

project = "Interlock"
extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["html_image"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
# Doxygen's pages stand beside those of Sphinx; only code/ links to them.
myst_url_schemes = {
    "http": None,
    "https": None,
    "doxygen": "../doxygen/{{path}}#{{fragment}}",
    "code": "code/{{path}}",
}
pygments_style = "default"
highlight_language = "none"
html_theme = "alabaster"
html_theme_options = {
    "description": "Control software for MRI-compatible surgical robots",
    "fixed_sidebar": True,
    "page_width": "1040px",
    "sidebar_width": "250px",
    "font_family": "Inter, system-ui, sans-serif",
    "head_font_family": "Inter, system-ui, sans-serif",
    "code_font_family": "'DejaVu Sans Mono', ui-monospace, monospace",
    "show_powered_by": False,
}
html_sidebars = {"**": ["about.html", "searchbox.html", "navigation.html"]}
templates_path = [str(HERE / "templates")]
html_static_path = [str(HERE / "static")]
html_css_files = ["site.css"]
html_js_files = ["search_form.js"]
html_show_copyright = False
html_show_sphinx = False
html_copy_source = False
html_permalinks = True
