"""Interface of every task of KV7xx."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from kinematify.manipulation.plan_request import Failure, Hold
    from kinematify.validation.check import OpenCheck


class RobotTask(Protocol):
    """A robot and what it is to do with the object: set up, planned, executed and filmed."""

    def set_up(self, result: OpenCheck) -> None:
        """Put robot and object together; add a finding where that makes no sense."""

    def plan(self) -> None:
        """Plan everything."""

    def tell_failures(self, result: OpenCheck, *failures: Failure) -> None:
        """Add the plans that failed at one of these steps."""

    def tell_successes(self, result: OpenCheck) -> None:
        """Add the plans that did not fail."""

    def tell_doubts(self, result: OpenCheck) -> None:
        """Add the plans whose joint the geometry doubts."""

    def tell_executions(self, result: OpenCheck, hold: Hold) -> None:
        """Execute the plans in the engine of the check, and add those that fail."""

    def tell_films(self, result: OpenCheck) -> None:
        """Film the executions, and add the names of the films."""
