"""One model on one recording: the scored samples, the prediction and its residual."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stribeck import _core
from stribeck.base.errors import FitError
from stribeck.base.pool import threads
from stribeck.identify.measured import NOT_SUMMED, Found, Measured, search_options
from stribeck.identify.smooth_channels import smooth_channels
from stribeck.identify.triangle import Triangle, triangles
from stribeck.identify.weights import root_weights
from stribeck.models.channels import ChannelArguments
from stribeck.models.model import Model
from stribeck.recording.motion.spring_torque import Resonance
from stribeck.recording.recording import Recording

Array = NDArray[np.float64]

#: Duration (s) for which steady-state points have slid: every state has settled.
SETTLED = 1e9

#: Laws that read only the sign of the motor torque.
SIGN_OF_MOTOR_TORQUE = ("clochiatti",)


@dataclass(frozen=True)
class Problem:
    """Predict the measured torque of `recording` by `model`.

    Parameters
    ----------
    rows : int array
        Indices of the samples whose residuals are summed. The state of a model evolves over the
        others too.
    load : array [n] or None
        The load torque that friction depends on, where the recording does not give it: that of
        the identified rigid body.
    span : (start, stop) or None
        The samples over which a model with a state is evaluated; None: all.
    loss_weight, held : arrays [n] or None
        Weights of a robust loss, times those of the recording; a part of the torque that is held.
    """

    recording: Recording
    model: Model
    rows: NDArray[np.intp]
    load: Array | None = None
    span: tuple[int, int] | None = None
    loss_weight: Array | None = None
    held: Array | None = None

    @cached_property
    def known(self) -> Array:
        """The torque known before a fit: the load torque, where given, and `held`, array [n]."""
        return self.recording.known_torque + (0.0 if self.held is None else self.held)

    @cached_property
    def target(self) -> Array:
        """The measured torque of `rows`, as recorded, array [m]."""
        return self.recording.torque[self.rows]

    @cached_property
    def torque_norm(self) -> float:
        """Norm of the measured torque of `rows`, weighted."""
        return float(np.sqrt(np.sum(self.weighted(self.target) ** 2)))

    @cached_property
    def _root_weights(self) -> Array | None:
        return root_weights(self.recording, self.loss_weight)

    def weighted(self, values: Array) -> Array:
        """`values` of the rows, array [m, ...], times the square roots of their weights."""
        if self._root_weights is None:
            return values
        root = self._root_weights[self.rows]
        return values * root.reshape(-1, *[1] * (values.ndim - 1))

    @cached_property
    def _all_channels(self) -> ChannelArguments:
        r = self.recording
        load = self.load if r.load_torque is None else r.load_torque
        return {
            "dt": np.full_like(r.velocity, SETTLED) if r.averaged else r.dt,
            "velocity": np.where(r.moving, r.velocity, r.denoised("velocity")),
            "position": r.position,
            "acceleration": r.acceleration,
            "temperature": r.temperature,
            "load_torque": load,
            "motor_torque": self._motor_sign,
            "external_torque": r.external_torque,
            "time": r.elapsed,
            "load_torque_curvature": self._load_curvature,
            "temperature_rate": self._temperature_rate,
            **({} if self.model.drive is None else {"enabled": r.enabled}),
            "mean_velocity": self._mean_velocity if self.model.has_state else None,
        }

    @cached_property
    def _load_curvature(self) -> Array | None:
        """Second derivative of the torque of the spring, for models that read it, array [n]."""
        if "elasticity" not in self.model.effects:
            return None
        return Resonance.of(self.model.core.constants).curvature(self.recording)

    @cached_property
    def _temperature_rate(self) -> Array | None:
        """Derivative of the temperature, for models that read it, array [n]."""
        if "thermometer_lag" not in self.model.effects:
            return None
        return self.recording.temperature_rate

    @cached_property
    def _motor_sign(self) -> Array | None:
        """Sign of the motor torque, for laws that distinguish motoring from generating, [n].

        Only the sign is used, so nothing is regressed on the measured torque: the sign selects one
        of two coefficients, and noise changes it only where the torque crosses zero. Laws that
        read the size of the motor torque are not given it: for them, and where the motor torque
        was not recorded, it follows from the torque balance with the predicted friction.
        """
        if self.model.law not in SIGN_OF_MOTOR_TORQUE or self.model.drive is not None:
            return None
        r = self.recording
        if r.load_torque is not None and not r.torque_holds_load:
            return np.sign(r.torque + r.load_torque)
        return np.sign(r.torque)

    @cached_property
    def _mean_velocity(self) -> Array:
        """Mean velocity over each step, which deflects a bristle, array [n].

        From positions where they were recorded: position differences do not accumulate velocity
        noise.
        """
        r = self.recording
        if r.averaged:
            return r.velocity
        before = np.concatenate([[0], np.arange(r.time.size - 1)])
        mean = 0.5 * (r.velocity + r.velocity[before])
        if r.position is not None and not r.columns["position"].derived:
            step = np.where(r.dt > 0, r.dt, np.inf)
            mean = np.where(r.dt > 0, (r.position - r.position[before]) / step, mean)
        return mean

    @cached_property
    def _row_channels(self) -> ChannelArguments:
        """The channels of `rows` alone, for models without memory."""
        channels: ChannelArguments = {
            name: None if column is None else np.ascontiguousarray(column[self.rows])
            for name, column in self._all_channels.items()
        }
        # An identified load is a term of the model: the torque balance must not count it twice.
        return {**channels, "shift_load": self.recording.load_torque is not None}

    @cached_property
    def _smooth(self) -> dict[str, Array] | None:
        """What a delay shifts; None for a model without one."""
        return smooth_channels(self.recording, self.load) if "delay" in self.model.effects else None

    def _channels_at(self, at: slice | NDArray[np.intp]) -> ChannelArguments:
        """The channels of some samples, for models with memory."""
        delayed: ChannelArguments = {}
        if self._smooth is not None:
            smooth = {name: column[at] for name, column in self._smooth.items()}
            delayed = {"smooth": smooth, "shift_load": self.recording.torque_holds_load}
        channels = {
            name: None if column is None else column[at]
            for name, column in self._all_channels.items()
        }
        known = {"shift_load": self.recording.load_torque is not None}
        return {**channels, **known, **delayed}

    def _stretch(self, start: int, stop: int, values: Array) -> ChannelArguments:
        """The channels of contiguous samples; the data decides in which state each run starts.

        Behind a voltage drive each run starts at zero deflection.
        """
        if not self.in_core or self._moving_begins(start, stop).size == 0:
            return self._channels_at(slice(start, stop))
        measured = self._measured(start, stop)
        slides = _core.slides(self.model.core, measured, values)
        channels: ChannelArguments = measured["columns"]
        dt = channels["dt"].copy()
        dt[measured["begins"]] = np.where(slides, np.inf, 0.0)
        return {**channels, "dt": dt}

    @property
    def in_core(self) -> bool:
        """Whether the core linearises the model: every model without a voltage drive."""
        return self.model.drive is None

    @cached_property
    def _own(self) -> Measured:
        """The data of the fit, in the form of the core."""
        root = self._root_weights
        if self.model.memoryless:
            return {
                "columns": self._row_channels,
                "target": self.target - self.known[self.rows],
                "scale": None if root is None else root[self.rows],
                "group": np.zeros(self.rows.size, dtype=np.uint32),
                "begins": [],
                "moving": np.ones(self.rows.size, dtype=bool),
                "torque_norm": self.torque_norm,
                "threads": threads(),
            }
        return self._measured(*(self.span or (0, self.recording.time.size)))

    def _measured(self, start: int, stop: int) -> Measured:
        """Contiguous samples, in the form of the core."""
        r, root = self.recording, self._root_weights
        group = np.full(stop - start, NOT_SUMMED)
        group[self.rows[(self.rows >= start) & (self.rows < stop)] - start] = 0
        return {
            "columns": self._channels_at(slice(start, stop)),
            "target": (r.torque - self.known)[start:stop],
            "scale": None if root is None else root[start:stop],
            "group": group,
            "begins": (self._moving_begins(start, stop) - start).tolist(),
            "moving": r.moving[start:stop],
            "torque_norm": self.torque_norm,
            "threads": threads(),
        }

    def _moving_begins(self, start: int, stop: int) -> NDArray[np.intp]:
        """Samples at which a run starts in motion, for models with a state."""
        r = self.recording
        if not self.model.has_state or r.averaged:
            return np.empty(0, dtype=np.intp)
        begins = ~(r.dt[start:stop] > 0.0)
        begins[:1] = True
        return start + np.flatnonzero(begins & r.moving[start:stop])

    def predict(self, values: Array, rows: NDArray[np.intp] | None = None) -> Array:
        """Predicted torque of every sample, array [n], or of some `rows`, array [m].

        Raises
        ------
        FitError
            The model is not defined at these values, or at some sample.
        """
        with self._named_errors():
            if rows is not None and self.model.memoryless:
                some = self._channels_at(rows)
                return self.model.predictor.torque(values, **some) + self.known[rows]
            predicted = self.predict_stretch(values, 0, self.recording.time.size)
        return predicted if rows is None else predicted[rows]

    def predict_stretch(self, values: Array, start: int, stop: int) -> Array:
        """Predicted torque of contiguous samples, which no state enters from before."""
        with self._named_errors():
            channels = self._stretch(start, stop, values)
            return self.model.predictor.torque(values, **channels) + self.known[start:stop]

    def by_run(self, values: Array) -> list[Problem]:
        """The problems whose models have `values`: one, unless parameters differ by run."""
        return [replace(self, model=self.model.with_values(values))]

    def residual(self, values: Array) -> Array:
        """Measured minus predicted torque of `rows`, array [m]."""
        return self.linearise(values, np.empty(0, dtype=np.intp))[0]

    def linearise(
        self, values: Array, wanted: NDArray[np.intp] | None = None
    ) -> tuple[Array, Array]:
        """Residual (measured minus predicted) of `rows`, and derivatives of the prediction.

        Parameters
        ----------
        wanted : int array [k]
            Indices of the parameters to differentiate by; default: all.

        Returns
        -------
        residual [m], jacobian [m, k]
        """
        chosen = None if wanted is None else wanted.tolist()
        if self.model.memoryless:
            torque, jacobian = self.model.predictor.gradient(
                values, **self._row_channels, wanted=chosen
            )
        else:
            start, stop = self.span or (0, self.recording.time.size)
            torque, jacobian = self.model.predictor.gradient(
                values, **self._stretch(start, stop, values), wanted=chosen
            )
            torque, jacobian = torque[self.rows - start], jacobian[self.rows - start]
        return self.target - self.known[self.rows] - torque, jacobian

    def triangle(self, values: Array, wanted: NDArray[np.intp], slope: Array) -> Triangle | None:
        """Factors at `values`, columns of the parameters `wanted` times `slope`, arrays [k].

        None where the model is not finite, or not defined.
        """
        if self.in_core:
            with self._named_errors():
                made = _core.triangles_of(
                    self.model.core, self._own, 1, values, wanted.tolist(), slope
                )
            return None if made is None else Triangle.of_whole(made[0])
        try:
            residual, jacobian = self.linearise(values, wanted)
        except _core.ModelError:
            # A law of the catalog refuses values at which it is not defined.
            return None
        scaled = Triangle.of(self.weighted(jacobian * slope), self.weighted(residual))
        # One number that is not finite makes the factor not finite.
        return scaled if np.all(np.isfinite(scaled.whole())) else None

    def triangles(
        self, values: Array, wanted: NDArray[np.intp], group: NDArray[np.uint32], groups: int
    ) -> list[Triangle]:
        """Factors of each group of samples, by the parameters `wanted` [k].

        Parameters
        ----------
        group : array [m]
            Which of the `groups` each of `rows` belongs to.

        Raises
        ------
        FitError
            The model is not finite at `values`.
        """
        if not self.in_core:
            residual, jacobian = self.linearise(values, wanted)
            return triangles(self.weighted(jacobian), self.weighted(residual), group, groups)
        own = self._own["group"].copy()
        own[own != NOT_SUMMED] = group
        with self._named_errors():
            made = _core.triangles_of(
                self.model.core,
                {**self._own, "group": own},
                groups,
                values,
                wanted.tolist(),
                np.ones(wanted.size),
            )
        if made is None:
            raise FitError(f"{self.model.spec} on {self.recording.path} is not finite")
        return [Triangle.of_whole(whole) for whole in made]

    def search(self, starts: Array, within: Mapping[str, object]) -> list[Found]:
        """The results of the core's searches from `starts` [k, p], on all threads."""
        with self._named_errors():
            return _core.search(self.model.core, self._own, starts, within)

    def reduced(
        self, points: Array, lower: Array, upper: Array, sloped: bool
    ) -> list[tuple[Array, float, Array] | None]:
        """Values with the best linear parameters, sums of squares and slopes at `points` [n, p]."""
        within = search_options(self.model, lower, upper)
        with self._named_errors():
            return _core.reduced(self.model.core, self._own, points, within, sloped)

    @contextmanager
    def _named_errors(self) -> Iterator[None]:
        """Name the model and the recording in an error of the core."""
        try:
            yield
        except _core.ModelError as error:
            raise FitError(f"{self.model.spec} on {self.recording.path}: {error}") from None

    def thinned(self, most: int) -> Problem:
        """The same problem on at most `most` rows, evenly spaced."""
        step = -(-self.rows.size // most)
        return self if step <= 1 else replace(self, rows=self.rows[::step])

    def window(self, most: int) -> Problem:
        """The same problem on at most `most` contiguous samples, those with the most reversals."""
        size = self.recording.time.size
        if size <= most:
            return self
        turned = np.diff(np.sign(self.recording.velocity), prepend=0.0) != 0
        count = np.cumsum(turned)
        starts = np.arange(0, size - most + 1, most // 4)
        start = int(starts[np.argmax(count[starts + most - 1] - count[starts])])
        rows = self.rows[(self.rows >= start) & (self.rows < start + most)]
        return replace(self, rows=rows, span=(start, start + most))
