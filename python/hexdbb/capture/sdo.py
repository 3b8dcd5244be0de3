"""Service data: read and write objects of a node, every write read back.

`canopen` carries the transfers. Two of its defaults are changed: it would give a node 0.3 s once, and its setters go on
when a device did not obey.
"""

from __future__ import annotations

import configparser
from pathlib import Path

import canopen
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from hexdbb.capture.transport import one_line
from hexdbb.errors import InputError, RunError

RESPONSE_TIMEOUT_S = 0.5
TRIES = 3

Value = int | float


class RemoteDevice:
    """One node as the controller sees it: its name for messages, its EDS, its objects.

    Parameters
    ----------
    network : canopen network the node is on
    node_id : 1 to 127
    role : what the node is to the user, for example ``slider 3``
    eds : its EDS file

    Raises
    ------
    InputError
        The EDS is not there or cannot be read.
    """

    def __init__(self, network: canopen.Network, node_id: int, role: str, eds: Path) -> None:
        self.node_id, self.role, self.eds = node_id, role, eds
        self._node = network.add_node(node_id, _dictionary(eds, node_id))
        self._node.sdo.RESPONSE_TIMEOUT = RESPONSE_TIMEOUT_S
        self._node.sdo.MAX_RETRIES = TRIES

    @property
    def label(self) -> str:
        """Name of the node in messages."""
        return f"node {self.node_id} ({self.role})"

    def has(self, index: int, subindex: int) -> bool:
        """Whether the EDS describes the object."""
        return self._node.object_dictionary.get_variable(index, subindex) is not None

    def default(self, index: int, subindex: int) -> Value | None:
        """Value the EDS (or the DCF's ParameterValue) gives the object."""
        variable = self._node.object_dictionary.get_variable(index, subindex)
        if variable is None:
            return None
        value: Value | None = variable.value if variable.value is not None else variable.default
        return value

    def read(self, index: int, subindex: int = 0) -> Value:
        """Read an object.

        Raises
        ------
        RunError
            The node does not answer or refuses: names node and object.
        """
        try:
            value: Value = self._variable(index, subindex).raw
        except SdoCommunicationError:
            raise RunError(
                f"{self.label}: no answer reading {name(index, subindex)} (expected a node on the bus)"
            ) from None
        except SdoAbortedError as error:
            raise RunError(f"{self.label}: object {name(index, subindex)} cannot be read: {error}") from None
        return value

    def write(self, index: int, subindex: int, value: Value) -> None:
        """Write an object and read it back.

        Raises
        ------
        RunError
            The node does not answer, refuses, or reads back another value: names node, object and values.
        """
        self.send(index, subindex, value)
        found = self.read(index, subindex)
        if found != value:
            raise RunError(
                f"{self.label}: object {name(index, subindex)} reads back {found} (expected {value} as written)"
            )

    def send(self, index: int, subindex: int, value: Value) -> None:
        """Write an object that cannot be read back as written, such as a PDO's COB-ID on its way to another state.

        Raises
        ------
        RunError
            The node does not answer or refuses.
        """
        try:
            self._variable(index, subindex).raw = value
        except SdoCommunicationError:
            raise RunError(f"{self.label}: no answer writing {value} to {name(index, subindex)}") from None
        except SdoAbortedError as error:
            raise RunError(f"{self.label}: object {name(index, subindex)} refuses {value}: {error}") from None

    def _variable(self, index: int, subindex: int) -> canopen.sdo.SdoVariable:
        entry = self._node.sdo[index]
        return entry if isinstance(entry, canopen.sdo.SdoVariable) else entry[subindex]


def name(index: int, subindex: int) -> str:
    """Index and sub-index as CiA writes them: 6065:00."""
    return f"{index:04X}:{subindex:02X}"


def _dictionary(eds: Path, node_id: int) -> canopen.ObjectDictionary:
    """Parse an EDS or DCF; cp1252 files of some vendors are read as such."""
    try:
        with eds.open(encoding="cp1252", errors="replace") as file:
            return canopen.import_od(file, node_id)
    except OSError as error:
        raise InputError(f"{eds}: cannot be read: {error.strerror} (expected the EDS of node {node_id})") from None
    except (configparser.Error, ValueError, KeyError) as error:
        raise InputError(f"{eds}: not an EDS: {one_line(error)} (expected the EDS of node {node_id})") from None
