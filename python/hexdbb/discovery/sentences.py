"""The answer of a discovery in one sentence that a fitter understands: which cause, and how much it explains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hexdbb.discovery.result import Cause, Verdict
from hexdbb.discovery.words import joined, percent, unseen_words
from hexdbb.evidence.fit.heldout import HeldOut
from hexdbb.files.plain_text import capital
from hexdbb.learned.places import is_learned

UNKNOWN = "something is missing that no known effect explains"
NEAR = "something is missing that known effects explain in part only, or do not predict"
MOST_RIVALS = 3
"""Sets named beside a cause from which they are not told: a reader keeps no more; the table has them all."""


def verdict_sentence(grade: Verdict, causes: Sequence[Cause], share: float, heldout: Mapping[str, HeldOut]) -> str:
    """Return a verdict in one sentence.

    Parameters
    ----------
    grade : str
        `effect`, `ambiguous` or `unknown`.
    causes : sequence of Cause
        At least one, the largest first.
    share : float
        What they explain together of what the model missed.
    heldout : mapping of str to HeldOut
        How they predict what was left out.
    """
    if grade == "unknown":
        is_near = not any(is_learned(each.choice) for each in causes)
        # Known effects that are not named for sure do not predict, or not what the readings need them for.
        explained = explained_words(len(causes), share, {} if is_near else heldout)
        return f"{NEAR if is_near else UNKNOWN}: {_list([each.clause for each in causes])}; {explained}"
    explained = explained_words(len(causes), share, heldout)
    named = [each.clause for each in causes if each.verdict != "unknown"]
    clause = capital("; ".join(named))
    if grade == "ambiguous":
        clause = f"{clause}, or these readings do not tell it from {_best(causes[0].rivals)}"
    beside = [each.clause for each in causes if each.verdict == "unknown"]
    if beside:
        clause = f"{clause}; beside it something that no known effect explains: {_list(beside)}"
    return f"{clause}; {explained}"


def likely_sentence(causes: Sequence[Cause], share: float, heldout: Mapping[str, HeldOut]) -> str:
    """Return the likely cause in one sentence, for who has asked where a model fails and not yet why."""
    clauses = []
    for each in causes:
        others = f" (or {_best(each.rivals)}, which explains these readings as well)" if each.rivals else ""
        known = "no known effect, " if is_learned(each.choice) else ""
        clauses.append(f"{known}{each.clause}{others}")
    likely = "likely cause" if len(causes) == 1 else "likely causes"
    return f"{likely}: {_list(clauses)}; {explained_words(len(causes), share, heldout)}"


def explained_words(count: int, share: float, heldout: Mapping[str, HeldOut]) -> str:
    """Return how much some causes explain, and on which readings not used to find them."""
    unseen = unseen_words(heldout, share)
    subject = "it explains" if count == 1 else "together they explain"
    return f"{subject} {percent(share)} of what the model missed" + (f", {unseen}" if unseen else "")


def _best(rivals: Sequence[str]) -> str:
    """Return the first of what a cause is not told from, and how many more there are."""
    more = len(rivals) - MOST_RIVALS
    return joined([*rivals[:MOST_RIVALS], *([f"{more} more"] if more > 0 else [])])


def _list(clauses: Sequence[str]) -> str:
    """Return clauses with colons and commas of their own as a list."""
    return "; and ".join(clauses)
