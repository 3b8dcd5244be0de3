"""One servo axis: a position demand, and a drive that follows it.

Model: the demand moves linearly to each new target over the interpolation period. The position x follows the demand d
as a first-order lag with velocity feed-forward k: tau x' = (d - x) + k tau d'. For a demand of constant velocity v the
error e = d - x is e(t) = e_v + (e(0) - e_v) exp(-t/tau), e_v = (1 - k) tau v. Each step is exact: results do not
depend on the step size.
Assumption: stops (quick stop, fault reaction, power off with brake) are ramps of constant deceleration of the demand.
Units: mm, s.
"""

from __future__ import annotations

import math

STANDSTILL_MM = 1e-4
"""Following error below which a stopped axis is at standstill, mm: one count of the shipped encoder scale."""


class ServoAxis:
    """Motion of one axis.

    Parameters
    ----------
    position_mm : float
        Position at power-on, mm.
    lag_s : float
        Time constant tau of the position loop, s, greater than 0.
    feedforward : float
        Velocity feed-forward k: 0 for none, 1 for no lag at constant velocity.

    Attributes
    ----------
    position_mm, velocity_mm_s : float
        Position and mean velocity of the last cycle.
    demand_mm, demand_velocity_mm_s : float
        Position demand and its velocity.
    jammed : bool
        Whether an injected fault blocks the slider.
    """

    def __init__(self, position_mm: float, lag_s: float, feedforward: float) -> None:
        self.position_mm = self.demand_mm = position_mm
        self.demand_velocity_mm_s = 0.0
        self.velocity_mm_s = 0.0
        self.jammed = False
        self._lag_s, self._feedforward = lag_s, feedforward

    @property
    def following_error_mm(self) -> float:
        """Demand minus position, mm."""
        return self.demand_mm - self.position_mm

    @property
    def at_standstill(self) -> bool:
        """Whether neither demand nor slider moves."""
        return self.demand_velocity_mm_s == 0.0 and (self.jammed or abs(self.following_error_mm) < STANDSTILL_MM)

    def hold_here(self) -> None:
        """Set the demand to the present position, so that nothing jumps at the next command."""
        self.demand_mm, self.demand_velocity_mm_s = self.position_mm, 0.0

    def follow(self, target_mm: float, interpolation_s: float, dt_s: float, limit_mm_s: float) -> bool:
        """Move towards a target for one cycle.

        Parameters
        ----------
        target_mm : float
            Target position, mm.
        interpolation_s : float
            Interpolation period (60C2h), s; 0 or less for the cycle.
        dt_s : float
            Cycle, s.
        limit_mm_s : float
            Velocity limit (607Fh), mm/s.

        Returns
        -------
        bool
            Whether the velocity limit was in force.
        """
        period_s = interpolation_s if interpolation_s > 0.0 else dt_s
        ramp_s = period_s if period_s < dt_s else dt_s
        velocity_mm_s = wanted_mm_s = (target_mm - self.demand_mm) / period_s
        if not -limit_mm_s <= wanted_mm_s <= limit_mm_s:
            velocity_mm_s = math.copysign(limit_mm_s, wanted_mm_s)
        start_mm = self.position_mm
        self._advance(velocity_mm_s, ramp_s)
        if velocity_mm_s == wanted_mm_s and interpolation_s <= dt_s:
            self.demand_mm = target_mm  # no rounding left behind
        if dt_s > ramp_s:
            self._advance(0.0, dt_s - ramp_s)
        self.demand_velocity_mm_s = velocity_mm_s
        self.velocity_mm_s = (self.position_mm - start_mm) / dt_s
        return velocity_mm_s != wanted_mm_s

    def brake(self, dt_s: float, deceleration_mm_s2: float) -> None:
        """Decelerate the demand for one cycle of `dt_s` seconds at `deceleration_mm_s2`."""
        speed, start_mm = abs(self.demand_velocity_mm_s), self.position_mm
        ramp_s = min(dt_s, speed / deceleration_mm_s2)
        if ramp_s > 0.0:
            left = speed - deceleration_mm_s2 * ramp_s
            left = 0.0 if ramp_s < dt_s else left
            self._advance(math.copysign((speed + left) / 2.0, self.demand_velocity_mm_s), ramp_s)
            self.demand_velocity_mm_s = math.copysign(left, self.demand_velocity_mm_s)
        if dt_s > ramp_s:
            self.demand_velocity_mm_s = 0.0
            self._advance(0.0, dt_s - ramp_s)
        self.velocity_mm_s = (self.position_mm - start_mm) / dt_s

    def _advance(self, velocity_mm_s: float, dt_s: float) -> None:
        """Advance the lag exactly, for a demand of constant velocity."""
        steady_mm = (1.0 - self._feedforward) * self._lag_s * velocity_mm_s
        error_mm = steady_mm + (self.demand_mm - self.position_mm - steady_mm) * math.exp(-dt_s / self._lag_s)
        self.demand_mm += velocity_mm_s * dt_s
        if not self.jammed:
            self.position_mm = self.demand_mm - error_mm
