"""One servo axis: a position demand, and a slider drive that follows it.

Model: the demand moves linearly to each new target over the interpolation period. The position x follows the demand d
as a first-order lag with velocity feed-forward k: tau x' = (d - x) + k tau d'. For a demand of constant velocity v the
error e = d - x is e(t) = e_v + (e(0) - e_v) exp(-t/tau), e_v = (1 - k) tau v, which is stepped exactly: results do not
depend on a step size.
Assumption: stops (quick stop, fault reaction, power off with brake) are ramps of constant deceleration of the demand.
Units: mm, s.
"""

from __future__ import annotations

import math

STANDSTILL_MM = 1e-4
"""Distance from the demand below which a stopped axis stands."""


class ServoAxis:
    """Motion of one slider drive.

    Parameters
    ----------
    position_mm : float
        Where it stands at power-on.
    lag_s : float
        Time constant tau of the position loop, greater than 0.
    feedforward : float
        Velocity feed-forward k, 0 none, 1 no lag at constant velocity.
    """

    def __init__(self, position_mm: float, lag_s: float, feedforward: float) -> None:
        self.position_mm = self.demand_mm = position_mm
        self.demand_velocity_mm_s = 0.0
        self.velocity_mm_s = 0.0
        self.jammed = False
        self._lag_s, self._feedforward = lag_s, feedforward

    @property
    def following_error_mm(self) -> float:
        """Demand minus position."""
        return self.demand_mm - self.position_mm

    @property
    def standing(self) -> bool:
        """Whether nothing moves any more."""
        return self.demand_velocity_mm_s == 0.0 and (self.jammed or abs(self.following_error_mm) < STANDSTILL_MM)

    def hold_here(self) -> None:
        """Take the present position as demand: nothing jumps at the next command."""
        self.demand_mm, self.demand_velocity_mm_s = self.position_mm, 0.0

    def follow(self, target_mm: float, interpolation_s: float, dt_s: float, limit_mm_s: float) -> bool:
        """Move towards a target for one cycle.

        Returns
        -------
        bool
            Whether the velocity limit held the demand back.
        """
        ramp_s = min(interpolation_s, dt_s) if interpolation_s > 0.0 else dt_s
        wanted_mm_s = (target_mm - self.demand_mm) / (interpolation_s if interpolation_s > 0.0 else dt_s)
        velocity_mm_s = min(max(wanted_mm_s, -limit_mm_s), limit_mm_s)
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
        """Run the demand's velocity down for one cycle."""
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
        """Step the lag exactly for a demand of constant velocity."""
        steady_mm = (1.0 - self._feedforward) * self._lag_s * velocity_mm_s
        error_mm = steady_mm + (self.following_error_mm - steady_mm) * math.exp(-dt_s / self._lag_s)
        self.demand_mm += velocity_mm_s * dt_s
        if not self.jammed:
            self.position_mm = self.demand_mm - error_mm
