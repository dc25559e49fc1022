"""Row of the table: a figure or table of the paper, what is measured for it, and what is accepted."""

import dataclasses
import typing

RESULT, TIME = "result", "time"  # kinds of a measurement: equal on every machine, or dependent on it


@dataclasses.dataclass
class Measurement:
    """A quantity beside that of the paper."""

    quantity: str   # with its unit
    paper: str      # as the paper states it; "–": not stated
    here: str
    accepted: str = "–"                        # condition of acceptance; "–": none
    holds: typing.Optional[bool] = None        # None: not judged
    agrees: typing.Optional[bool] = None       # with the paper; None: the paper states nothing to compare with
    kind: str = RESULT

    def cells(self, row):
        """Line of reproduce.csv."""
        words = {True: "yes", False: "no", None: "–"}
        return {"row": row, "quantity": self.quantity, "the paper": self.paper, "here": self.here,
                "agrees": words[self.agrees], "accepted": self.accepted, "holds": words[self.holds], "kind": self.kind}


@dataclasses.dataclass
class Row:
    """A figure or table of the paper."""

    name: str       # of the option --row and of the picture NAME.png
    title: str      # in the paper
    paper: str      # content of the figure, in words
    fast: bool      # less than half a minute
    measure: typing.Optional[typing.Callable]  # (folder for results and picture) -> measurements; None: not reproducible
    picture: str    # of the page, relative to docs; empty: none
    agreement: str  # in words


def number(value, digits=3):
    """Text of a number with significant digits."""
    return "%.*g" % (digits, value)


def below(value, limit):
    """Text of a number that is round-off: only that it is below a limit."""
    return "< %g" % limit if value < limit else number(value, 1)


def series(values, digits=3):
    """Text of numbers."""
    return ", ".join(number(value, digits) for value in values)


def is_sorted(values):
    """True if no value is smaller than the one before it."""
    return all(a <= b for a, b in zip(values, values[1:]))


def spread(values):
    """Largest difference of the values, relative to the largest one [1]."""
    return (max(values) - min(values)) / max(abs(value) for value in values)
