"""How a page of the documentation is set: what stays together on a line."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

HOOKS = Path(__file__).resolve().parents[3] / "tests/studies/reference"
SPACE = "\N{NO-BREAK SPACE}"


def hook(name: str) -> ModuleType:
    found = importlib.util.spec_from_file_location(f"hook_{name}", HOOKS / f"{name}.py")
    assert found is not None and found.loader is not None
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


@pytest.mark.parametrize(
    ("written", "shown"),
    [
        ("83 % of 100 000 samples", f"83{SPACE}% of 100{SPACE}000{SPACE}samples"),
        ("at -0.978 rad/s2", f"at \N{MINUS SIGN}0.978{SPACE}rad/s²"),
        ("5 N m, kg m2 &lt; 3", f"5{SPACE}N{SPACE}m, kg m²{SPACE}&lt;{SPACE}3"),
        ("on AVX-512 held-out", 'on <span class="whole">AVX-512</span> held-out'),
        ("<code>--per-run</code>", '<code class="whole">--per-run</code>'),
        ("<pre><code>5 N -3</code></pre>", "<pre><code>5 N -3</code></pre>"),
        ("<td>N m s2/rad2</td>", f'<td class="whole">N{SPACE}m{SPACE}s²/rad²</td>'),
    ],
)
def test_text_is_set(written: str, shown: str):
    assert hook("typography").on_page_content(written) == shown


def test_a_picture_opens_in_full_size():
    shown = hook("typography").on_page_content('<p><img alt="A" src="a.png" /></p>')
    assert shown == '<p class="picture"><a href="a.png"><img alt="A" src="a.png" /></a></p>'


def test_a_comment_of_a_command_is_no_command():
    block = (
        '<div class="language-console highlight"><pre><span></span><code><span class="gp"># </span>'
        '<span class="k">for</span> each name\n<span class="go">stribeck fit -o a.toml</span>\n'
        "</code></pre></div>"
    )
    shown = hook("typography").on_page_content(hook("command_lines").on_page_content(block))
    assert '<span class="c1"># for each name</span>' in shown
    assert '<span class="whole">-o a.toml</span>' in shown
