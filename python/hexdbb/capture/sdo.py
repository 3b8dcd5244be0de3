"""Service data (SDO): read and write objects of a node; every written value is read back.

`canopen` carries the transfers. Three of its ways are replaced: it waits 0.3 s and tries once, its setters return
normally if a device did not accept a value, and an answer that comes late counts as that to the next request.
Source: CiA 301, SDO protocol and abort codes; CiA 306, EDS files.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import canopen
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from hexdbb.capture.eds.file import read_eds
from hexdbb.capture.frames import SDO_ANSWER_BASE
from hexdbb.capture.late_answers import PromptClient
from hexdbb.capture.link import Link
from hexdbb.capture.transport import one_line
from hexdbb.errors import RunError

SDO_REQUEST_BASE = 0x600
"""CAN identifier of node 0 (predefined connection set)."""
SDO_TIMEOUT_S = 0.5
"""Longest time to wait for the answer to one SDO request, s.

CiA 301 states none. Drives answer within some 10 ms, but slower where they store a value, and a node simulated on a
desktop may be stalled for some tenths of a second (`canopen`'s 0.3 s is too close to that). It is not a key of the
machine file's ``[can]`` section: it only decides how soon a node that does not answer is reported.
"""
SDO_TRIES = 3
"""Number of times a request is sent before the node counts as not answering, so that one lost frame does not refuse a
run; a node that is switched off is reported after 3 x 0.5 s = 1.5 s."""

MAX_SEGMENTS = 16
"""Number of segments of one SDO transfer, of up to 7 bytes each. The objects read here are numbers of up to 8 bytes."""

Value = int | float


class RemoteDevice:
    """One node as the controller sees it: its name in messages, its EDS, its objects.

    Parameters
    ----------
    network : Link
        The network the node is on.
    node_id : int
        1 to 127.
    role : str
        Function of the node, for example ``slider 3``.
    eds : Path
        Its EDS or DCF.

    Raises
    ------
    InputError
        The EDS does not exist or cannot be parsed.
    """

    def __init__(self, network: Link, node_id: int, role: str, eds: Path) -> None:
        self.node_id, self.role, self._network = node_id, role, network
        self.eds = read_eds(eds, node_id)
        dictionary = self.eds.dictionary()
        # Not `canopen.RemoteNode`: it also makes PDOs of the EDS, and raises for one that describes them in part.
        self._sdo = PromptClient(SDO_REQUEST_BASE + node_id, SDO_ANSWER_BASE + node_id, dictionary)
        self._sdo.RESPONSE_TIMEOUT, self._sdo.MAX_RETRIES = SDO_TIMEOUT_S, SDO_TRIES
        self._sdo.network = network
        network.subscribe(SDO_ANSWER_BASE + node_id, self._sdo.on_response)

    @property
    def label(self) -> str:
        """Name of the node in messages: ``node 3 (slider 3)``."""
        return f"node {self.node_id} ({self.role})"

    def has(self, index: int, subindex: int) -> bool:
        """Return whether the EDS describes an object."""
        return self.eds.get(index, subindex) is not None

    def writable(self, index: int, subindex: int) -> bool:
        """Return whether the EDS describes an object that SDO may write."""
        described = self.eds.get(index, subindex)
        return described is not None and described.writable

    def default(self, index: int, subindex: int) -> Value | None:
        """Return the value of an object in the EDS (DefaultValue) or DCF (ParameterValue); None if it has none."""
        described = self.eds.get(index, subindex)
        return None if described is None else described.value

    def read(self, index: int, subindex: int = 0) -> Value:
        """Read an object.

        Returns
        -------
        int or float
            Its value.

        Raises
        ------
        RunError
            The node does not answer within `SDO_TRIES` times `SDO_TIMEOUT_S`, or refuses; names node and object.
        """
        with self._transfer(index, subindex, f"reading {name(index, subindex)}", "cannot be read"):
            value = self._upload(index, subindex)
        if not isinstance(value, int | float):
            place = f"object {name(index, subindex)} in {self.eds.path}"
            raise RunError(f"{self.label}: {place} is of another data type (expected a number)")
        return value

    def write(self, index: int, subindex: int, value: Value) -> None:
        """Write an object and read it back.

        Raises
        ------
        RunError
            The node does not answer, refuses, or reads back another value; names node, object and values.
        """
        self.send(index, subindex, value)
        found = self.read(index, subindex)
        if found != value:
            raise RunError(
                f"{self.label}: object {name(index, subindex)} reads back {found} (expected {value} as written)"
            )

    def send(self, index: int, subindex: int, value: Value) -> None:
        """Write an object that does not read back as written, such as the COB-ID of a PDO while it is disabled.

        Raises
        ------
        RunError
            The node does not answer or refuses.
        """
        doing = f"writing {value} to {name(index, subindex)}"
        with self._transfer(index, subindex, doing, f"refuses {value}"):
            self._variable(index, subindex).raw = value

    @contextmanager
    def _transfer(self, index: int, subindex: int, doing: str, refused: str) -> Iterator[None]:
        """Turn whatever a transfer raises into one message; a bus that is lost passes."""
        try:
            yield
        except (RunError, can.CanError, OSError):
            raise
        except SdoAbortedError as error:
            raise RunError(f"{self.label}: object {name(index, subindex)} {refused}: {error}") from None
        except Exception as error:  # `canopen` raises what its parsers raise for an answer they do not expect
            malformed = self._network.malformed.get(self.node_id)
            if malformed is None and type(error) is SdoCommunicationError and "No SDO response" in str(error):
                raise RunError(f"{self.label}: no answer {doing} (expected a node on the bus)") from None
            found = malformed or one_line(error)
            raise RunError(f"{self.label}: {doing} failed: {found} (expected an SDO answer as in CiA 301)") from None

    def _upload(self, index: int, subindex: int) -> object:
        """Read an object in at most `MAX_SEGMENTS`; `canopen` would follow a transfer that never ends."""
        variable = self._variable(index, subindex).od
        with self._sdo.open(index, subindex, buffering=0) as stream:
            pieces: list[bytes] = []
            while len(pieces) < MAX_SEGMENTS and (piece := stream.read(7)):
                pieces.append(piece)
        data = b"".join(pieces)
        # Some devices send 32 bits whatever the type.
        return variable.decode_raw(data[: len(variable) // 8] if variable.fixed_size else data)

    def _variable(self, index: int, subindex: int) -> canopen.sdo.SdoVariable:
        if not self.has(index, subindex):
            raise RunError(f"{self.label}: {self.eds.lacks(index, subindex)} (expected one)")
        entry = self._sdo[index]
        return entry if isinstance(entry, canopen.sdo.SdoVariable) else entry[subindex]


def name(index: int, subindex: int) -> str:
    """Return index and sub-index as CiA writes them: 6065:00."""
    return f"{index:04X}:{subindex:02X}"
