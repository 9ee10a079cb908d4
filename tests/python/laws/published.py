"""Parameter values printed in the papers, by law and symbol."""

from __future__ import annotations


def _numbered(*values: float) -> dict[str, float]:
    return {f"a{k}": value for k, value in enumerate(values, start=1)}


#: UR5e review 2024/25, table 7: every law fitted to joint 1, in the order of print.
VELOCITY_LAWS = {
    "bittencourt_a": _numbered(-1388, 1395, -12.62, 1.12, 96.30),
    "clochiatti": _numbered(12.03, 10.84, 10.79),
    "coulomb": _numbered(12.35, 10.30),
    "dong": _numbered(10.45, 13.61, 16.34, 3.24, 16.34),
    "gaz_a": _numbered(10.54, -13.55, 26.89, 25.37, 0.02),
    "gaz_b": _numbered(71.87, 1.79, 0.01),
    "grotjahn_a": _numbered(5.58, 3.14, 15.92),
    "grotjahn_b": _numbered(10.13, 3.01, 7.24, 22.65),
    "hao_a": _numbered(8.06, 22.66, -7.26, 1.24),
    "indri_a": _numbered(6.03, 4.06, 899.76, 13.04, -0.98, 15.59),
    "makkar": _numbered(7.07, 0.84, -17.93, 4.04, 88486, 8.37),
    "shao": _numbered(10.25, 14.12, 33.75),
    "wolf": _numbered(306.24, -4.30, 44.35, 0.89, 18.29, 0.10),
    "zhou": _numbered(19.33, 0.58, -379.32, 264.32, 366.69, 5.50),
}

THERMAL_LAWS = {
    "bittencourt_b": _numbered(
        -5.26, -0.04, 0.43, -3.72, 1887, 15.83, -0.07, -38.75, 77.72, 10.93, 169.30, 6.95
    ),
    "hao_b": _numbered(8.16, 40.32, -25.34, 6.92, -0.02),
    "iskandar": _numbered(
        0.05, 0.63, 1.77, -0.04, 8.11, -0.70, 0.01, 21.16, 0.19, -0.01, 0.18, 0.01, -0.0001
    ),
    "li": _numbered(-0.18, -0.82, 6.99, 0.06, 16.77, -0.06, 0.001, -0.008),
    "madsen": _numbered(6.36, 0.44, 2.99, -0.28, 40.68, 50.39, -30.75, 7.57),
    "nevmerzhitskiy": _numbered(4.26, -0.01, 20.40, -87.40, 309.89),
    "simoni": _numbered(10.09, 49.89, -31.35, 8.57, 0.81, -0.01),
}

DYNAMIC_LAWS = {
    "dahl": _numbered(26350, 81.09, 25.43),
    "indri_b": _numbered(90124, 1699, 29859, 496.74, 6198, 9.25, 3646, 0.04, -71.88, -4.13),
    "lugre": _numbered(102467, 562.39, -91.75, 74716, 7.70, 1002, 0.94),
    "tadese_t": _numbered(
        14753, 467.25, 31.20, 10.31, -0.89, 10.26, -0.11, 74.88, 4870, 717.03, -32.26
    ),
}

TABLE_7 = {**VELOCITY_LAWS, **THERMAL_LAWS, **DYNAMIC_LAWS}

#: Bittencourt et al. 2010: the speed-only model beside figure 10, and tables I and II.
M0 = {"Fc": 4.90e-2, "Fs": 8.44e-2, "Fv": 5.00e-4, "vs": 6.50}
M_STAR = {
    "Fc0": 3.04e-2,
    "Fc_load": 2.32e-2,
    "Fs_load": 1.28e-1,
    "vs_load": 9.07,
    "Fs0": -2.44e-2,
    "Fs_T": 1.69e-3,
    "vs0": -25.00,
    "vs_T": 1.00,
    "Fv0": 1.29e-4,
    "Fv_T": 1.31e-3,
    "TV": 21.00,
}

#: Indri et al., table 1: (c0, c1, c2, c3, c4, w1, w2) by joint and direction.
DIRECT_DRIVE = {
    (1, "plus"): (40.854, -32.454, -31.233, -0.760, -0.262, 0.19, 0.17),
    (1, "minus"): (-46.473, 53.873, 55.738, -0.293, 0.177, 0.14, 0.15),
    (2, "plus"): (17.837, -14.837, -14.998, -0.156, -0.050, 0.2, 0.19),
    (2, "minus"): (3.408, -0.408, -0.635, -0.104, 0.036, 0.3, 0.1),
}

#: Valdiero group, table 1. Printed in N s2/m2; a viscous coefficient is in N s/m.
GANTRY = {"Fc": 10300.0, "Fs": 12300.0, "vs": 0.002, "s2_plus": 3.2189e3, "s2_minus": 1.5277e4}


def direct_drive(joint: int) -> dict[str, float]:
    """Both directions of one joint of `DIRECT_DRIVE`, by symbol."""
    names = ("c0", "c1", "c2", "c3", "c4", "w1", "w2")
    return {
        f"{name}_{side}": value
        for side in ("plus", "minus")
        for name, value in zip(names, DIRECT_DRIVE[joint, side], strict=True)
    }
