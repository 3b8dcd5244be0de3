"""Which mounts of several records are one and the same fixing of the cup, with one position in a fit.

A record's mounts count as fixings of its own, unless they are given the name of a fixing (`hexdbb.plan.Mount.fixing`):
mounts of one name and number are one, in whatever records they stand.
Assumptions users get wrong: a cup that was taken off and put back stands elsewhere by hundredths of a millimetre, and
is another fixing. So is a ball that was moved to another place of the platform.
"""

from __future__ import annotations

from collections.abc import Sequence

from hexdbb.errors import InputError
from hexdbb.model import MountKey
from hexdbb.record import Record

NAMED = "fixing {}"
"""Takes the place of a record's hash in the key of a mount that several records may have."""


def mount_key(record: Record, mount_id: int) -> MountKey:
    """Return what a mount of a record is known by."""
    name = record.mount(mount_id).fixing
    return MountKey(record.content_hash() if name is None else NAMED.format(name), mount_id)


def require_agreement(records: Sequence[Record]) -> None:
    """Check that mounts that are one fixing have the same cup and the same bar.

    Raises
    ------
    InputError
        They differ; names both files, the fixing, the key, its value and the expected one.
    """
    first: dict[MountKey, Record] = {}
    for record in records:
        for mount in record.mounts:
            if mount.fixing is None:
                continue
            other = first.setdefault(mount_key(record, mount.id), record)
            pairs = {
                "cup_mm": (list(mount.cup_mm), list(other.mount(mount.id).cup_mm)),
                "bar_length_mm": (record.gauge.bar_length_mm, other.gauge.bar_length_mm),
            }
            for key, (value, expected) in pairs.items():
                if value != expected:
                    where = f'{record.name}: mount {mount.id}, fixing "{mount.fixing}": {key}'
                    raise InputError(
                        f"{where}: {value} (expected {expected}, as in {other.name}; another set-up needs another name)"
                    )


def shared_words(records: Sequence[Record]) -> list[str]:
    """Return one line for each fixing that several records share: the records, and its name."""
    names: dict[str, list[str]] = {}
    for record in records:
        for name in dict.fromkeys(mount.fixing for mount in record.mounts if mount.fixing is not None):
            names.setdefault(name, []).append(record.name)
    return [f'{", ".join(each)}: one set-up, "{name}"' for name, each in names.items() if len(each) > 1]
