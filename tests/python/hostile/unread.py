"""Rows of options in a mode of a command that does not read them: the call, and what is said."""

from __future__ import annotations

Row = tuple[str, str]

_SIMULATE = "simulate m.toml --inertia 1"
_COMPENSATE = "compensate m.toml --inertia 1"
_PULL = f"{_SIMULATE} --spring 3 --pull-speed 1"
_PLAN = "plan m.toml --show stribeck --position=-1:1 --speed 1 --acceleration 5"
_STROKE = "only with --trajectory quintic or trapezoid"
_TRACKED = "has no effect with --guided, only without it"

ROWS: tuple[Row, ...] = (
    *(
        row
        for call in (_SIMULATE, _COMPENSATE)
        for row in (
            (f"{call} --period 3", "with --trajectory quintic, only with --trajectory fourier"),
            (f"{call} --acceleration 3", "only with --trajectory trapezoid: omit --acceleration"),
            (f"{call} --trajectory trapezoid --period 3", "only with --trajectory fourier"),
            (f"{call} --trajectory fourier --speed 3", _STROKE),
            (f"{call} --trajectory fourier --dwell 3", _STROKE),
            (f"{call} --trajectory fourier --acceleration 3", "only with --trajectory trapezoid"),
            (f"{call} --temperature 40", "--temperature has no effect with coulomb, only with"),
            (f"{call} --gravity 3", "--gravity has no effect with --inertia, only with --mass"),
            (f"{call} --pitch 0.01", "--pitch has no effect with --inertia, only with --mass"),
        )
    ),
    ("simulate published:gantry/table_1/gantry_map --mass 1 --gravity-cos 3", "with --inertia"),
    ("simulate m.toml --gravity-sin 3", "has no effect with the rigid body of MODEL"),
    ("simulate m.toml --rotor-inertia 3", "has no effect with the rigid body of MODEL"),
    (f"{_SIMULATE} --torque 1 --pull-speed 3", "--pull-speed has no effect with --torque"),
    (f"{_SIMULATE} --kp 9 --kd 1 --bandwidth 3", "--bandwidth has no effect with --kp and --kd"),
    *(
        (f"{call} {words}", f"{words.split()[0]} has no effect with --{name}")
        for call, name in ((_PULL, "spring"), (f"{_SIMULATE} --torque 1", "torque"))
        for words in (
            "--trajectory quintic", "--from 1", "--to 1", "--speed 1", "--acceleration 1",
            "--dwell 1", "--period 1", "--kp 1", "--ki 1", "--kd 1", "--bandwidth 1", "--limit 1",
            "--feedforward",
        )
    ),
    *(
        (f"{_COMPENSATE} --guided {words}", _TRACKED)
        for words in (
            "--observer 5", "--bandwidth 5", "--kp 5", "--ki 1", "--gain 1", "--plot new.png",
        )
    ),
    (f"{_COMPENSATE} --kp 9 --ki 1 --gain 1 --bandwidth 3", "only without one of them"),
    (f"{_COMPENSATE} --factor 0.5 --box velocity=-1:1", "only with --factor largest"),
    (f"{_COMPENSATE} --factor largest --box temperature=1:2", "temperature=1:2 has no effect"),
    ("check m.toml --box temperature=10:50", "only with a model that depends on temperature"),
    ("check m.toml --box load_torque=10:50", "--box load_torque=10:50 has no effect"),
    ("export m.toml --to c new --box temperature=10:50", "--box temperature=10:50 has no effect"),
    ("export m.toml --to json new --box load_torque=1:5", "coulomb, which depends on velocity,"),
    ("fit log.csv coulomb --sample-rows 2000", "has no effect without --stream, only with it"),
    ("fit log.csv coulomb --grid a1=0:1:3", "with --method rms, only with --method grid"),
    ("fit log.csv coulomb --loaded other.csv", "only with --method three_step"),
    ("fit log.csv coulomb --resamples 50", "only with --errors bootstrap"),
    *(
        (f"fit log.csv coulomb --method grid {words}", "only with --method rms")
        for words in (
            "--passive", "--per-run a2", "--errors profile", "--estimator iv", "--starts 3",
        )
    ),
    (f"{_PLAN} --joint 1", "--joint has no effect with a model file alone, only with DATA"),
    (f"{_PLAN} --starts 3", "--starts has no effect with a model file alone, only with DATA"),
    (f"{_PLAN} --where v>0", "--where has no effect with a model file alone, only with DATA"),
    (_PLAN.replace("m.toml", "log.csv coulomb") + " --noise 1", "only with a model file alone"),
    ("report p.toml --gear-ratio 2", "--gear-ratio has no effect for a project"),
    ("report p.toml --starts 2", "--starts has no effect for a project"),
    ("compare log.csv m.toml --loss huber", "has no effect with model files alone, which are not"),
    ("plot log.csv m.toml -o new.png --algorithm slsqp", "only with a spec: omit --algorithm"),
    ("points log.csv --method breakaway --bins 3", "--bins has no effect with --method breakaway"),
    ("points log.csv --method coast_down --trim 0.1", "only with --method averaging, segments or"),
    ("points log.csv --method presliding --shortest 1", "only with --method averaging"),
    ("points log.csv --method presliding -o new.csv", "-o has no effect with --method presliding"),
    ("project reject p.toml load --undo --because no", "--because has no effect with --undo"),
    ("fleet log.csv --model coulomb --base coulomb -o new", "only with --model improve"),
    ("fleet log.csv --since 2020-01-01 --window 3 -o new", "--window has no effect with --since"),
    ("fleet log.csv --scheduler nowhere --workers 1 -o new", "has no effect with --scheduler"),
    ("generate -o new.csv --every 2", "--every has no effect for a single joint, only with"),
    ("generate -o new.csv --robot ur5e --law lugre", "has no effect with --robot ur5e, only for"),
)  # fmt: skip
