"""Whole robots: rigid bodies and the friction of every joint, identified together.

Names are imported when they are first used; `__init__.pyi` says where each of them lives.

Examples
--------
>>> from stribeck import robot
>>> arm = robot.from_tables("planar", [{"a": 0.4}, {"a": 0.3}])
>>> arm.names
('1', '2')
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
