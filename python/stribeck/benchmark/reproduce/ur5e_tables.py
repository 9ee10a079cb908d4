"""Tables 4 to 6 of the UR5e review as printed."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Errors:
    """One line: errors of joint 1 (mean, standard deviation), energy and its error.

    Attributes
    ----------
    mean, std
        Friction torque, measured minus modelled, N m.
    energy, energy_error
        J, of all joints.
    percent
        The energy error in per cent of the measured energy.
    """

    mean: float
    std: float
    energy: float
    energy_error: float
    percent: float


@dataclass(frozen=True)
class Table:
    """A table: its number, what was measured, the law from which our data are made, its lines.

    Attributes
    ----------
    number
        Of the table.
    test
        The motion: 1 (trapezoidal), 2 (fifth-degree polynomials).
    truth
        The law with the smallest standard deviation; its printed parameters make our friction.
    measured_energy
        J, of all joints.
    decimals
        Of the printed energies.
    """

    number: int
    test: int
    truth: str
    measured_energy: float
    decimals: int
    lines: dict[str, Errors]


TABLE_4 = Table(
    4,
    1,
    "gaz_a",
    772.57,
    2,
    {
        "bittencourt_a": Errors(0.32, 2.66, 775.13, -2.56, -0.33),
        "clochiatti": Errors(0.02, 2.86, 772.98, -0.41, -0.05),
        "coulomb": Errors(0.05, 3.07, 775.37, -2.80, -0.36),
        "dong": Errors(0.29, 2.59, 775.07, -2.50, -0.32),
        "gaz_a": Errors(0.00, 2.44, 774.85, -2.28, -0.30),
        "gaz_b": Errors(1.34, 4.34, 767.21, 5.36, 0.69),
        "grotjahn_a": Errors(0.30, 2.55, 775.17, -2.60, -0.34),
        "grotjahn_b": Errors(0.29, 2.57, 775.08, -2.51, -0.32),
        "hao_a": Errors(0.29, 2.73, 775.23, -2.65, -0.34),
        "indri_a": Errors(0.25, 2.53, 775.10, -2.53, -0.33),
        "makkar": Errors(0.23, 2.52, 775.05, -2.48, -0.32),
        "shao": Errors(0.31, 2.61, 775.07, -2.50, -0.32),
        "wolf": Errors(0.23, 2.51, 775.14, -2.57, -0.33),
        "zhou": Errors(0.32, 2.62, 774.86, -2.29, -0.30),
    },
)
TABLE_5 = Table(
    5,
    2,
    "li",
    17452.0,
    0,
    {
        "bittencourt_b": Errors(-0.20, 3.19, 17512.0, -60.78, -0.35),
        "hao_b": Errors(-0.06, 2.82, 17525.0, -73.36, -0.42),
        "iskandar": Errors(-0.27, 2.36, 17513.0, -61.50, -0.35),
        "li": Errors(0.00, 2.46, 17457.0, -5.09, -0.03),
        "madsen": Errors(-0.10, 2.71, 17514.0, -61.97, -0.36),
        "nevmerzhitskiy": Errors(-0.16, 2.97, 17519.0, -67.86, -0.39),
        "simoni": Errors(-0.06, 2.81, 17525.0, -73.36, -0.42),
    },
)
TABLE_6 = Table(
    6,
    2,
    "lugre",
    2121.0,
    0,
    {
        "dahl": Errors(-0.70, 9.14, 1680.0, 441.23, 20.80),
        "indri_b": Errors(0.12, 1.94, 2126.0, -4.56, -0.22),
        "lugre": Errors(0.12, 1.89, 2128.0, -6.59, -0.31),
    },
)
#: The line of table 6 whose data are those of table 5.
TADESE = Errors(0.04, 3.27, 17337.0, 114.92, 0.66)
TABLES = (TABLE_4, TABLE_5, TABLE_6)
#: Errors of joint 2: mean and standard deviation, N m.
JOINT_2 = {
    "bittencourt_a": (-0.86, 3.08),
    "clochiatti": (-0.26, 2.63),
    "coulomb": (-1.12, 3.70),
    "dong": (-0.78, 2.96),
    "gaz_a": (0.00, 2.94),
    "gaz_b": (-0.36, 3.44),
    "grotjahn_a": (-0.78, 3.00),
    "grotjahn_b": (-0.79, 2.96),
    "hao_a": (-0.89, 3.24),
    "indri_a": (-0.78, 2.95),
    "makkar": (-0.76, 2.95),
    "shao": (-0.79, 2.96),
    "wolf": (-0.77, 2.99),
    "zhou": (-0.77, 2.99),
    "bittencourt_b": (-0.85, 3.07),
    "hao_b": (-0.85, 2.71),
    "iskandar": (-0.91, 2.51),
    "li": (0.00, 2.50),
    "madsen": (-0.86, 2.67),
    "nevmerzhitskiy": (-0.92, 2.71),
    "simoni": (-0.85, 2.71),
    "dahl": (-0.36, 5.19),
    "indri_b": (-0.73, 2.34),
    "lugre": (-0.74, 2.26),
}
