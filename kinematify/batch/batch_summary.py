"""Summary of a batch: counts, times and failures, and a page with all objects."""

from __future__ import annotations

import math
import posixpath
from collections import Counter
from statistics import fmean
from typing import TYPE_CHECKING

from kinematify.batch.batch_inputs import filesystem
from kinematify.batch.convert import REPORT_FILE, THUMBNAIL_FILE, VIEW_FILE
from kinematify.batch.manifest import read_manifests
from kinematify.batch.run_batch import OBJECTS
from kinematify.errors import OutputError
from kinematify.validation.formats.html_frame import rendered

if TYPE_CHECKING:
    from collections.abc import Sequence

    from kinematify.batch.manifest import ObjectRecord

PAGE_FILE = "index.html"
STEP_HEADINGS = ("step", "objects", "mean [s]", "95 % within [s]", "most [s]", "share")


def outcome_words(records: Sequence[ObjectRecord]) -> str:
    """``12 written (9 pass, 2 warn, 1 fail), 1 unusable, 1 timeout``."""
    verdicts = Counter(record.verdict for record in records if record.verdict)
    judged = ", ".join(f"{verdicts[word]} {word}" for word in ("pass", "warn", "fail") if verdicts[word])
    counts = Counter(record.status for record in records)
    words = [f"{counts[status]} {status}" for status in ("unusable", "error", "timeout", "crash") if counts[status]]
    return ", ".join([f"{counts['ok']} written" + (f" ({judged})" if judged else ""), *words])


def step_rows(records: Sequence[ObjectRecord]) -> list[tuple[str, ...]]:
    """Return how long each step took, over the objects that had it."""
    seconds: dict[str, list[float]] = {}
    for record in records:
        for step, value in record.step_seconds.items():
            seconds.setdefault(step, []).append(value)
    total = sum(map(sum, seconds.values())) or 1.0
    rows = []
    for step, values in seconds.items():
        of_times = (fmean(values), sorted(values)[math.ceil(0.95 * len(values)) - 1], max(values))
        rows.append((step, str(len(values)), *(f"{time:.2f}" for time in of_times), f"{sum(values) / total:.0%}"))
    return rows


def as_page(records: Sequence[ObjectRecord]) -> str:
    """Return a page that lists all objects, with links to their folders beside it."""
    return rendered(
        "batch.html",
        title=f"kinematify batch: {outcome_words(records)}",
        beside=True,
        step_headings=STEP_HEADINGS,
        steps=step_rows(records),
        records=records,
        objects=OBJECTS,
        thumbnail=THUMBNAIL_FILE,
        view=VIEW_FILE,
        report=REPORT_FILE,
    )


def write_page(out: str) -> str:
    """Write the page of an output, of all its shares; return its path or URL.

    Raises:
        OutputError: It cannot be written.
    """
    place = posixpath.join(out, PAGE_FILE)
    fs, path = filesystem(place)
    try:
        fs.pipe_file(path, as_page(read_manifests(out)).encode())
    except OSError as error:
        raise OutputError(
            f"The page {place} cannot be written: {error.strerror or error}. The manifest beside it is whole; make "
            "room and call the command again with --resume."
        ) from error
    return place
