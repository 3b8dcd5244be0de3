"""The SYNC counter (1019h): agreed with all nodes, sent with every SYNC, checked by the simulated nodes."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
from canopen.sdo import SdoAbortedError
from tests.circle_plan import circle_plan
from tests.faults.messages import Frame, Way
from tests.faults.proxy import proxied
from tests.faults.transformations import FOREVER, Rule, changed, followed_by, twice
from tests.programs import called
from tests.python.capture.eds_mutations import DRIVE, GAUGE
from tests.python.capture.scripted_bus import ScriptedBus
from tests.rigs import rig_in_thread

from hexdbb.capture.exchange import Exchange
from hexdbb.capture.frames import GuardedBus
from hexdbb.capture.sync_counter import LARGEST, configure_sync_counter
from hexdbb.errors import RunError
from hexdbb.machine import shipped
from hexdbb.record import read_record
from hexdbb.rig.dictionary import Dictionary
from hexdbb.rig.sync_counter import ERROR_PROTOCOL, ERROR_SYNC_LENGTH, SyncCounter

SECTION = """
[1019]
ParameterName=Synchronous counter overflow value
ObjectType=0x7
DataType=0x0005
AccessType=rw
DefaultValue=0
PDOMapping=0
"""
EXACT = 'schema = "hexdbb.truth/1"\ngauge = {noise_um = 0.1, resolution_um = 0.1}\n'


def with_counter(path: Path) -> str:
    """Return the text of a shipped EDS with object 1019h."""
    text = path.read_text(encoding="ascii")
    head, _, rest = text.partition("[OptionalObjects]\nSupportedObjects=")
    number, _, objects = rest.partition("\n")
    count = int(number, 0) + 1
    body, blank, tail = objects.partition("\n\n")
    return f"{head}[OptionalObjects]\nSupportedObjects={count}\n{body}\n{count}=0x1019{blank}{tail}\n{SECTION}"


@pytest.fixture
def counting(tmp_path: Path) -> tuple[Path, Path]:
    """Plan and machine file of a machine all of whose devices have object 1019h."""
    (tmp_path / "drive.eds").write_text(with_counter(DRIVE))
    (tmp_path / "gauge.eds").write_text(with_counter(GAUGE))
    machine = shipped("sp120.toml").read_text(encoding="utf-8")
    for name, eds in (("hexglider_drive.eds", "drive.eds"), ("ballbar_gauge.eds", "gauge.eds")):
        assert name in machine
        machine = machine.replace(f"eds/{name}", eds).replace(name, eds)
    (tmp_path / "machine.toml").write_text(machine, encoding="utf-8")
    plan = circle_plan("noise_um = 0.1, resolution_um = 0.1").replace('"sp120"', '"machine.toml"')
    assert "machine.toml" in plan
    (tmp_path / "plan.toml").write_text(plan)
    (tmp_path / "truth.toml").write_text(EXACT)
    return tmp_path / "plan.toml", tmp_path / "machine.toml"


def run(counting: tuple[Path, Path], *rules: Rule) -> tuple[int, str, list[int]]:
    """Run in lockstep through a proxy; return exit status, error and, without other rules, the numbers of all SYNCs."""
    plan, machine = counting
    options = ("--machine", machine, "--truth", plan.with_name("truth.toml"), "--seed", 1)
    numbers: list[int] = []

    def seen(data: bytes) -> bytes:
        numbers.append(data[0] if data else 0)
        return data

    rules = rules or (Rule(0x080, Way.TO_NODES, changed(seen), None, FOREVER),)
    with rig_in_thread(*options) as port, proxied(port, rules, 0.02) as proxy:
        words = ("--bus", proxy.bus, "--lockstep", "--rate", 50, "--yes")
        done = called("hexdbb-run", "--plan", plan, "-o", plan.with_name("run.parquet"), *words)
    return done.returncode, done.stderr, numbers


def test_nodes_with_1019h_get_numbered_syncs(counting: tuple[Path, Path]) -> None:
    status, err, numbers = run(counting)
    assert status == 0, err
    assert numbers[:3] == [1, 2, 3]
    assert max(numbers) == LARGEST
    assert numbers == [k % LARGEST + 1 for k in range(len(numbers))]
    assert read_record(counting[0].with_name("run.parquet")).complete


def test_without_1019h_syncs_carry_no_data(tmp_path: Path) -> None:
    bus = ScriptedBus()
    for overflow, data in ((0, [b""] * 3), (2, [b"\1", b"\2", b"\1"])):
        bus.sent.clear()
        exchange = Exchange(GuardedBus(bus), (1, 2, 3, 4, 5, 6), 7, lambda *_: None, overflow)
        for _ in range(3):
            exchange.send_sync()
        assert [sent for can_id, sent in bus.sent if can_id == 0x080] == data


def test_a_sync_of_another_producer_is_named_with_its_number(counting: tuple[Path, Path]) -> None:
    foreign = Rule(0x182, Way.TO_CONTROLLER, followed_by(Frame(0x080, b"\x4d"), to_nodes=True), 5.0)
    status, err, _ = run(counting, foreign)
    assert status == 1
    assert "SYNC of another producer, counter 77" in err or "EMCY 8200h" in err


def test_a_repeated_sync_is_ignored_by_nodes_that_count(counting: tuple[Path, Path]) -> None:
    status, err, _ = run(counting, Rule(0x080, Way.TO_NODES, twice, 5.0))
    assert status == 0, err
    assert read_record(counting[0].with_name("run.parquet")).complete


def node_with(eds: Path) -> tuple[SyncCounter, Dictionary, list[int]]:
    dictionary, codes = Dictionary(eds, 1, assumed={(0x1019, 0): 0, (0x1006, 0): 0}), list[int]()
    return SyncCounter(dictionary, codes.append), dictionary, codes


@pytest.mark.parametrize(
    ("numbers", "accepted", "reported"),
    [
        ([1, 2, 3, 1, 2], [True] * 5, []),
        ([2, 2, 3], [True, False, True], []),
        ([1, 3, 1], [True] * 3, [ERROR_PROTOCOL]),
        ([1, None, 2], [True, False, True], [ERROR_SYNC_LENGTH]),
    ],
)
def test_a_node_counts(tmp_path: Path, numbers: list[int | None], accepted: list[bool], reported: list[int]) -> None:
    eds = tmp_path / "drive.eds"
    eds.write_text(with_counter(DRIVE))
    counter, dictionary, codes = node_with(eds)
    dictionary.download(0x1006, 0, bytes(4))
    dictionary.download(0x1019, 0, b"\3")
    assert [counter.accepts(b"" if each is None else bytes([each])) for each in numbers] == accepted
    assert codes == reported


def test_1019h_is_written_only_without_a_sync_period_and_within_its_range(tmp_path: Path) -> None:
    eds = tmp_path / "drive.eds"
    eds.write_text(with_counter(DRIVE))
    _, dictionary, _ = node_with(eds)
    with pytest.raises(SdoAbortedError):
        dictionary.download(0x1019, 0, b"\2")
    dictionary.download(0x1006, 0, bytes(4))
    for value in (b"\1", b"\xf1"):
        with pytest.raises(SdoAbortedError):
            dictionary.download(0x1019, 0, value)
    dictionary.download(0x1019, 0, b"\2")


def device(label: str, value: int | None, writable: bool = True) -> SimpleNamespace:
    """A node: value of its object 1019h, None where it has none."""
    written: dict[int, int] = {}
    return SimpleNamespace(
        label=label,
        eds=SimpleNamespace(path=Path(f"{label}.eds")),
        has=lambda index, sub: index != 0x1019 or value is not None,
        writable=lambda index, sub: index != 0x1019 or (value is not None and writable),
        read=lambda index, sub=0: value,
        write=lambda index, sub, new: written.__setitem__(index, new),
        written=written,
    )


@pytest.mark.parametrize(
    ("devices", "overflow", "written", "notes"),
    [
        ([("a", 0), ("b", 0)], LARGEST, [LARGEST, LARGEST], 0),
        ([("a", 0), ("b", None)], 0, [0, None], 0),
        ([("a", 10, False), ("b", 0)], 10, [None, 10], 0),
        ([("a", 10, False), ("b", None)], 10, [None, None], 1),
    ],
)
def test_nodes_agree_on_one_counter(
    devices: list[tuple[object, ...]], overflow: int, written: list[int | None], notes: int
) -> None:
    made = [device(*each) for each in devices]
    found, said = configure_sync_counter(made)
    assert found == overflow
    assert [each.written.get(0x1019) for each in made] == written
    assert len(said) == notes


def test_fixed_counters_that_differ_are_refused() -> None:
    with pytest.raises(RunError, match=r"^b: object 1019:00 is 10 and read-only \(expected 20"):
        configure_sync_counter([device("a", 20, False), device("b", 10, False)])
