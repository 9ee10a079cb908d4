"""stribeck: which physical effect is a friction model missing?

Read a recording, compare models with it, find the missing effect, add it, and compare the error on
data that the fit did not use.

Names are imported when they are first used; `__init__.pyi` says where each of them lives.

>>> import stribeck as sb
>>> sb.model("coulomb", coulomb_friction=2.0, viscous_friction=0.5).torque([-1.0, 1.0])
array([-2.5,  2.5])
"""

import lazy_loader

from .report import register_renderers as _register_renderers

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
_register_renderers()
