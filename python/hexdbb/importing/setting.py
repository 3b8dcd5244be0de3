"""What a file of readings does not say: gauge, circle, machine and feed, from the plan that was driven."""

from __future__ import annotations

from dataclasses import dataclass

from hexdbb.errors import InputError
from hexdbb.importing.mapping import Mapping
from hexdbb.machine import SHIPPED_MACHINE, MachineFile, load_machine, shipped_machine
from hexdbb.plan import Circle, Plan, load_plan, shipped_plans


@dataclass(frozen=True)
class Setting:
    """Plan and machine of an import.

    Attributes
    ----------
    plan : Plan
    plan_name : str
        As it was given.
    machine : MachineFile
    mapping : Mapping
    origin : str
        File that is imported, for errors.
    """

    plan: Plan
    plan_name: str
    machine: MachineFile
    mapping: Mapping
    origin: str

    def circle_id(self) -> int:
        """Return the circle of a file that has no column for it.

        Raises
        ------
        InputError
            The plan has several and none is chosen, or not the one that is.
        """
        ids = [circle.id for circle in self.plan.circles]
        chosen = self.mapping.circle
        if chosen is None and len(ids) == 1:
            return ids[0]
        names = ", ".join(map(str, ids))
        if chosen is None:
            raise InputError(
                f"{self.origin}: which circle of {self.plan_name} is not stated (expected --circle {names})"
            )
        self.circle(chosen, "circle")
        return chosen

    def circle(self, identity: int, where: str) -> Circle:
        """Return a circle by its id; `InputError` where the plan has none, `where` names what asks."""
        found = next((each for each in self.plan.circles if each.id == identity), None)
        if found is None:
            names = ", ".join(str(each.id) for each in self.plan.circles)
            expected = f"the id of a circle of {self.plan_name}: {names}"
            raise InputError(f"{self.origin}: {where}: {identity} (expected {expected})")
        return found

    def feeds_mm_min(self, circle: Circle) -> tuple[float, ...]:
        """Return the feeds that the plan has for a circle."""
        return circle.feeds_mm_min or self.plan.feeds_mm_min

    def every_feed_mm_min(self) -> list[float]:
        """Return all feeds of the plan and its circles."""
        return sorted({feed for circle in self.plan.circles for feed in self.feeds_mm_min(circle)})

    def feed_mm_min(self, circle: Circle) -> float:
        """Return the feed of a file that has no column for it; `InputError` where the plan has several."""
        if self.mapping.feed_mm_min is not None:
            return self.mapping.feed_mm_min
        feeds = self.feeds_mm_min(circle)
        if len(feeds) > 1:
            names = ", ".join(f"{each:g}" for each in feeds)
            raise InputError(
                f"{self.origin}: the feed is not stated; {self.plan_name} has {names} mm/min (expected --feed)"
            )
        return feeds[0]


def setting_of(mapping: Mapping, origin: str) -> Setting:
    """Read the plan and the machine that a mapping names.

    Raises
    ------
    InputError
        It names none, or a file that is wrong.
    """
    if mapping.plan is None:
        expected = f"--plan PLAN: a plan file, or a shipped plan ({', '.join(shipped_plans())})"
        raise InputError(f"{origin}: which circle was driven is not stated (expected {expected})")
    plan = load_plan(mapping.plan)
    named = mapping.machine
    if named is None:
        machine = plan.machine_file()
    else:
        machine = shipped_machine() if named == SHIPPED_MACHINE else load_machine(named)
    return Setting(plan, mapping.plan, machine, mapping, origin)
