"""Weights of the samples: cost, standard errors, held-out refits, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
import stribeck as sb
from as_user import stribeck
from numpy.typing import NDArray
from stribeck.identify.held_out import held_out_prediction
from stribeck.identify.problem import Problem
from stribeck.recording.weights import with_weights
from synthetic import COULOMB, VISCOUS, joint, motion, record

Array = NDArray[np.float64]
SPECS = ("coulomb", "lugre", "coulomb+delay", "coulomb+stribeck")
LUGRE = {
    "bristle_stiffness": 60.0,
    "bristle_damping": 2.0,
    "viscous_friction": 1.2,
    "coulomb_friction": 3.0,
    "static_friction": 4.5,
    "stribeck_velocity": 0.12,
    "stribeck_exponent": 2.0,
}


@pytest.fixture(scope="module")
def uneven() -> pl.DataFrame:
    """A joint whose noise is 20 times larger in every other stretch of 50 samples."""
    frame = joint(noise=0.0)
    sigma = np.where(np.arange(frame.height) // 50 % 2, 0.6, 0.03)
    noise = sigma * np.random.default_rng(5).standard_normal(frame.height)
    return frame.with_columns(torque=pl.col("torque") + pl.Series(noise), sigma=pl.Series(sigma))


@pytest.fixture(scope="module")
def recording(uneven: pl.DataFrame, tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    return record(tmp_path_factory.mktemp("weights"), uneven, weights="1/sigma^2")


@pytest.fixture(scope="module")
def curved(recording: sb.Recording, tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """The same noise and weights on a joint with a Stribeck curve."""
    v = motion()[2]
    curve = 1.5 * np.exp(-np.abs(v / 0.12)) * np.sign(v)
    made = joint(curve, noise=0.05)
    made = made.with_columns(weight=pl.Series(recording.weight))
    return record(tmp_path_factory.mktemp("curved"), made, weights="weight")


@pytest.fixture(scope="module")
def bristles(tmp_path_factory: pytest.TempPathFactory) -> sb.Recording:
    """A joint with LuGre friction whose presliding is slow enough for its rate."""
    v = motion()[2]
    lugre = sb.model("lugre", **LUGRE)  # type: ignore[arg-type]
    known = COULOMB * np.sign(v) + VISCOUS * v
    made = joint(lugre.torque(v, dt=0.01) - known, noise=0.05)
    return record(tmp_path_factory.mktemp("bristles"), made)


def by_hand(recording: sb.Recording) -> tuple[Array, Array]:
    """Values and standard errors of weighted linear regression, [viscous, Coulomb]."""
    r, root = recording, np.sqrt(recording.weight)
    known = r.torque - r.load_torque
    columns = np.column_stack([r.velocity, np.sign(r.velocity)])
    use = r.moving
    a, b = (columns * root[:, None])[use], (known * root)[use]
    values = np.linalg.solve(a.T @ a, a.T @ b)
    variance = np.sum((b - a @ values) ** 2) / (b.size - 2)
    return values, np.sqrt(variance * np.diag(np.linalg.inv(a.T @ a)))


def test_weighted_regression_by_hand(recording: sb.Recording) -> None:
    fitted = sb.fit("coulomb", recording, errors="independent")
    values, errors = by_hand(recording)
    assert fitted.model.values == pytest.approx(values, rel=1e-10)
    found = [e.stderr for e in fitted.estimates.values()]
    assert found == pytest.approx(errors, rel=1e-8)


def test_the_sandwich_takes_weights_too(recording: sb.Recording) -> None:
    """White noise: the robust standard errors are those of the textbook but for their own noise."""
    robust = sb.fit("coulomb", recording)
    _, errors = by_hand(recording)
    found = [e.stderr for e in robust.estimates.values()]
    assert found == pytest.approx(errors, rel=0.2)
    plain = sb.fit("coulomb", recording, weights=np.ones(recording.rows))
    assert all(
        a.stderr > 4.0 * b.stderr
        for a, b in zip(plain.estimates.values(), robust.estimates.values(), strict=True)
    )
    assert robust.model.values == pytest.approx([VISCOUS, COULOMB], abs=4.0 * max(errors))


def test_rmse_is_unweighted_and_the_weighted_one_beside_it(recording: sb.Recording) -> None:
    fitted = sb.fit("coulomb", recording)
    at, weight = recording.moving, recording.weight
    assert fitted.rmse == pytest.approx(np.sqrt(np.mean(fitted.residual[at] ** 2)))
    weighted = np.sum(weight[at] * fitted.residual[at] ** 2) / weight[at].sum()
    assert fitted.rmse_weighted == pytest.approx(np.sqrt(weighted))
    assert fitted.rmse > 5.0 * fitted.rmse_weighted
    assert fitted.to_dict()["rmse_weighted"] == fitted.rmse_weighted
    assert fitted.rmse_held_out_weighted == pytest.approx(fitted.rmse_weighted, rel=0.02)
    assert "weighted error" in repr(fitted)


def test_only_ratios_matter(curved: sb.Recording) -> None:
    one = sb.fit("coulomb+stribeck", curved, starts=4)
    other = sb.fit("coulomb+stribeck", curved, starts=4, weights=1e6 * curved.weight)
    assert other.model.values == pytest.approx(one.model.values, rel=1e-6)
    assert other.rmse_weighted == pytest.approx(one.rmse_weighted, rel=1e-9)


@pytest.mark.parametrize("spec", SPECS)
def test_a_weight_of_zero_leaves_a_sample_out(
    curved: sb.Recording, bristles: sb.Recording, spec: str
) -> None:
    """As exclusion does: samples of a transient are not fitted, though states run through them."""
    made = bristles if spec == "lugre" else curved
    bare = with_weights(made, np.ones(made.rows))
    out = (np.arange(made.rows) // 40) % 3 == 0
    zero = sb.fit(spec, bare, weights=(~out).astype(float), transient=np.zeros_like(out), starts=3)
    without = sb.fit(spec, bare, transient=out, starts=3)
    everything = sb.fit(spec, bare, transient=np.zeros_like(out), starts=3)
    assert apart(zero, without) < 1e-3
    assert apart(everything, without) > 0.2


@pytest.mark.parametrize("marks", [[True, False], np.zeros(3), [0, 1]])
def test_other_marks_of_a_transient_are_refused(curved: sb.Recording, marks: Any) -> None:
    with pytest.raises(sb.SpecError, match="give an array of True and False, one for each of the"):
        sb.fit("coulomb", curved, transient=marks)


def apart(one: sb.Fit, other: sb.Fit) -> float:
    """The largest difference of a parameter, in standard errors: not all are well determined."""
    errors = np.array([estimate.stderr for estimate in other.estimates.values()])
    return float(np.max(np.abs(one.model.values - other.model.values) / errors))


@pytest.mark.parametrize("exact", [True, False])
def test_held_out_refits_are_weighted(recording: sb.Recording, exact: bool) -> None:
    fitted = sb.fit("coulomb", recording)
    problem = Problem(recording, fitted.model, fitted.rows, fitted.load)
    lower, upper = np.full(2, -np.inf), np.full(2, np.inf)
    prediction, refits = held_out_prediction(
        problem, fitted.model.values, lower, upper, exact=exact
    )
    left = recording.block == 3
    silent = np.where(left, 0.0, recording.weight)
    expected, _ = by_hand(with_weights(recording, silent))
    assert refits[3] == pytest.approx(expected, rel=1e-9)
    known = np.column_stack([recording.velocity, np.sign(recording.velocity)]) @ expected
    use = left & recording.moving
    assert prediction[use] == pytest.approx((known + recording.load_torque)[use], rel=1e-9)


def test_the_loop_keeps_them(recording: sb.Recording) -> None:
    given = sb.fit("coulomb", recording, weights=recording.weight)
    # The same recording without these weights is not fitted again, which would lose them.
    assert sb.diagnose(given, recording).fit.recording.weight is not None
    assert sb.add(given, "stribeck").recording.weight is not None


@pytest.mark.parametrize(
    ("weights", "sentence"),
    [
        (np.ones(3), "3 weights for 3000 samples: give one for each"),
        (np.ones((3000, 2)), "3000 x 2 weights for 3000 samples"),
        (-np.ones(3000), "weight 0 is -1: give finite weights of at least 0"),
        (np.full(3000, np.nan), "weight 0 is nan"),
        (np.zeros(3000), "the weights of all scored samples are 0"),
        ("sigma", "`weights`: give one number for each sample"),
    ],
)
def test_arrays_that_are_no_weights(plain: sb.Recording, weights: Any, sentence: str) -> None:
    with pytest.raises(sb.RecordingError, match="weight") as refusal:
        sb.fit("coulomb", plain, weights=weights)
    assert sentence in str(refusal.value)


def test_the_command(uneven: pl.DataFrame, tmp_path: Path) -> None:
    path = tmp_path / "joint.csv"
    uneven.write_csv(path)
    done = stribeck("fit", path, "--model", "coulomb", "--weights", "1/sigma^2", "--json")
    made = json.loads(done.stdout)
    assert made["rmse"] > 5.0 * made["rmse_weighted"] > 0.0
    assert made["parameters"]["coulomb_friction"]["value"] == pytest.approx(COULOMB, abs=0.01)
    column = stribeck("inspect", path, "--weights", "sigma", "--json")
    assert json.loads(column.stdout)["columns"]["weight"]["from"] == "sigma"


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["fit", "{data}", "--model", "coulomb", "--weights", "-sigma"], "row 1 (line 2) is -0.03"),
        (["fit", "{data}", "--model", "coulomb", "--weights", "1/(sigma-0.6)^2"], "is inf: give"),
        (["fit", "{data}", "--model", "coulomb", "--weights", "sgima"], "did you mean 'sigma'?"),
        (["fit", "{data}", "--model", "coulomb", "--weights", "0"], "all scored samples are 0"),
        (
            ["fit", "{data}", "--method", "grid", "--model", "bittencourt_a", "--weights", "sigma"],
            "does not use weights: leave out --weights",
        ),
        (
            ["points", "{data}", "--method", "segments", "--weights", "sigma"],
            "does not use weights",
        ),
    ],
)
def test_what_cannot_be_is_one_line(
    uneven: pl.DataFrame, tmp_path: Path, words: list[str], sentence: str
) -> None:
    path = tmp_path / "joint.csv"
    uneven.write_csv(path)
    done = stribeck(*(word.format(data=path) for word in words))
    assert done.returncode == 2 and done.stdout == ""
    lines = [line for line in done.stderr.splitlines() if not line.startswith("note:")]
    assert len(lines) == 1 and sentence in lines[0], done.stderr


def test_passes_over_the_data_refuse_weights(uneven: pl.DataFrame, tmp_path: Path) -> None:
    uneven.write_parquet(tmp_path / "joint.parquet")
    with pytest.raises(sb.RecordingError, match="weights need all samples in memory"):
        sb.stream(tmp_path / "joint.parquet", weights="sigma")
