"""The operating box of an export is checked."""

from __future__ import annotations

from pathlib import Path

import pytest
import stribeck as sb


@pytest.mark.parametrize("to", ["c", "rust"])
@pytest.mark.parametrize(
    ("box", "message"),
    [
        ({"velocity": (1.0, -1.0)}, "velocity is 1:-1: give the lower end first"),
        ({"temperature": (50.0, 10.0)}, "temperature is 50:10: give the lower end first"),
        ({"velocty": (-1.0, 1.0)}, "the box cannot have 'velocty'"),
    ],
)
def test_a_reversed_side_is_refused(
    tmp_path: Path, to: str, box: dict[str, tuple[float, float]], message: str
) -> None:
    friction = sb.model("coulomb+temperature_viscous")
    friction = friction.with_values([p.start for p in friction.parameters])
    with pytest.raises(sb.SpecError, match=message):
        sb.export(friction, to, tmp_path, box={"velocity": (-1.0, 1.0), **box})
    assert not list(tmp_path.iterdir())
