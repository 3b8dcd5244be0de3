"""Each fault of the table, as a controller sees it on the bus."""

from __future__ import annotations

import struct

import can
import pytest
from canopen.sdo import SdoCommunicationError

from hexdbb.errors import InputError
from hexdbb.rig.faults import FAULTS, parse_fault

GAUGE, DRIVES = 7, range(1, 7)
FAULT, ENABLED, DISABLED, QUICK_STOP = 0x0008, 0x0027, 0x0040, 0x0007
AFTER_S, CYCLES = 0.2, 120  # 50 cycles of 4 ms, and time for reactions


def run(start, spec: str, cycles: int = CYCLES, wait_s: float = 20.0):
    """Enable, move slowly through the fault; gives the controller and the answers of all cycles."""
    controller = start("--fault", spec)
    controller.mount(ball_mm=(100.0, 0.0, 80.0))
    at = controller.ready()
    answers = []
    for step in range(cycles):
        answers.append(controller.cycle(0x0F, [count + 10 * step for count in at], wait_s=wait_s))
    return controller, answers


def state(answer: dict[int, bytes], node: int) -> int:
    return struct.unpack_from("<H", answer[node])[0] & 0x006F


def test_missing_node_says_nothing(start):
    controller = start("--fault", "node-missing:4")
    controller.talk()
    controller.nodes[4].sdo.RESPONSE_TIMEOUT = 0.3
    controller.nodes[4].sdo.MAX_RETRIES = 1
    with pytest.raises(SdoCommunicationError):
        _ = controller.nodes[4].sdo[0x1000].raw
    assert controller.nodes[5].sdo[0x1000].raw


def test_drive_fault_trips_one_drive_with_its_code(start):
    controller, answers = run(start, f"drive-fault:3@{AFTER_S}=0x7305")
    assert state(answers[10], 3) == ENABLED
    assert state(answers[-1], 3) == FAULT
    assert state(answers[-1], 2) == ENABLED
    assert controller.emergencies(3) == [0x7305]
    controller.talk()
    assert controller.nodes[3].sdo[0x603F].raw == 0x7305
    assert controller.nodes[3].sdo[0x1003][1].raw == 0x7305


def test_fault_is_reset_by_a_rising_edge_of_bit_7(start):
    controller, answers = run(start, f"drive-fault:3@{AFTER_S}")
    at = [struct.unpack_from("<i", answers[-1][node], 2)[0] for node in DRIVES]
    for word in (0x80, 0x00):
        controller.cycle(word, at)
    assert state(controller.cycle(0x00, at), 3) == DISABLED
    assert controller.emergencies(3) == [0x2310, 0x0000]


def test_jammed_slider_runs_into_a_following_error(start):
    controller = start("--fault", f"following-error:2@{AFTER_S}")
    at = controller.ready()
    words = []
    for step in range(400):
        answers = controller.cycle(0x0F, [count + 100 * step for count in at])
        words.append(struct.unpack_from("<H", answers[2])[0])
    assert any(word & 0x2000 for word in words)  # bit 13 first, within 6066h
    assert words[-1] & 0x006F == FAULT
    assert controller.emergencies(2) == [0x8611]


def test_limit_switch_stops_the_drive_and_shows_in_the_inputs(start):
    controller, answers = run(start, f"limit-switch:5@{AFTER_S}")
    word = struct.unpack_from("<H", answers[-1][5])[0]
    assert word & 0x006F == DISABLED
    assert word & 0x0800
    assert controller.emergencies(5) == [0x8612]
    controller.talk()
    assert controller.nodes[5].sdo[0x60FD].raw == 2


@pytest.mark.parametrize(("spec", "expected"), [("enable-lost:1", DISABLED), ("mode-lost:1", ENABLED)])
def test_drive_that_no_longer_follows(start, spec, expected):
    _, answers = run(start, f"{spec}@{AFTER_S}")
    word, position, mode = struct.unpack("<Hib", answers[-1][1])
    assert word & 0x006F == expected
    assert not word & 0x1000
    assert mode == (0 if spec.startswith("mode") else 8)
    assert struct.unpack_from("<i", answers[-2][1], 2)[0] == position


def test_unreferenced_drive_lacks_bit_15(start):
    controller = start("--fault", "not-homed:6")
    words = controller.statuswords(controller.cycle(0x0F, controller.ready()))
    assert [bool(word & 0x8000) for word in words] == [True] * 5 + [False]


def test_emcy_changes_no_state(start):
    controller, answers = run(start, f"emcy:7@{AFTER_S}=0x5010")
    assert controller.emergencies(7) == [0x5010]
    assert all(state(answers[-1], node) == ENABLED for node in DRIVES)


def test_lost_heartbeat_is_silent_and_the_node_works_on(start):
    controller = start("--fault", "heartbeat-lost:2")
    controller.talk()
    for node in controller.nodes.values():
        node.sdo[0x1017].raw = 10
    controller.loop()
    heard = [controller.receive(lambda m: m.arbitration_id > 0x700).arbitration_id - 0x700 for _ in range(60)]
    assert set(heard) == {1, 3, 4, 5, 6, 7}
    controller.talk()
    assert controller.nodes[2].sdo[0x1000].raw


def test_missing_tpdos_come_back_after_their_count(start):
    controller = start("--fault", "tpdo-missing:6@0.02=3")
    at = controller.ready()
    silent = [k for k in range(20) if 6 not in controller.cycle(0x0F, at, wait_s=0.3)]
    assert len(silent) == 3
    assert silent == list(range(silent[0], silent[0] + 3))


def test_boot_up_resets_the_node(start):
    controller, answers = run(start, f"boot-up:1@{AFTER_S}", cycles=60, wait_s=0.1)
    assert any(m.arbitration_id == 0x701 and bytes(m.data) == b"\0" for m in controller.other)
    assert 1 in answers[0]
    assert 1 not in answers[-1]


def test_nmt_change_takes_the_node_out_and_stops_it(start):
    controller, answers = run(start, f"nmt-change:1@{AFTER_S}", cycles=60, wait_s=0.1)
    assert 1 not in answers[-1]
    controller.talk()
    assert controller.nodes[1].sdo[0x6041].raw & 0x006F == DISABLED


@pytest.mark.parametrize(
    ("spec", "status"), [("gauge-out-of-range", 3), ("gauge-out-of-range@0.2=-5000", 5), ("gauge-break@0.2", 1)]
)
def test_gauge_status_tells_range_and_break(start, spec, status):
    _, answers = run(start, spec)
    assert struct.unpack("<fB", answers[-1][GAUGE])[1] == status


def test_frozen_gauge_repeats_itself(start):
    _, answers = run(start, f"gauge-frozen@{AFTER_S}")
    values = [struct.unpack("<fB", answer[GAUGE]) for answer in answers]
    assert len(set(values[:40])) > 10
    assert len(set(values[60:])) == 1
    assert values[-1][1] == 0


def test_stuck_gauge_reads_its_value_and_says_it_is_valid(start):
    _, answers = run(start, f"gauge-stuck@{AFTER_S}=12.5")
    values = [struct.unpack("<fB", answer[GAUGE]) for answer in answers]
    assert len(set(values[:40])) > 10
    assert set(values[60:]) == {(12.5, 0)}


def test_lost_bus_stops_the_drives_and_can_be_had_again(rig_process, connect):
    with rig_process("--fault", f"bus-lost@{AFTER_S}") as (port, _):
        controller = connect(port)
        at = controller.ready()
        with pytest.raises((can.CanError, OSError)):
            for step in range(200):
                controller.cycle(0x0F, [count + 10 * step for count in at], wait_s=0.1)
        controller.close()
        again = connect(port)
        again.talk()
        assert all(again.nodes[node].sdo[0x6041].raw & 0x006F == DISABLED for node in DRIVES)
        again.close()


def test_gauge_of_another_unit_says_so(start):
    controller = start("--fault", "gauge-unit")
    controller.talk()
    assert controller.nodes[GAUGE].sdo[0x6131][1].raw == 0xFD010000


def test_every_kind_has_a_text_and_is_tested_here():
    named = {"node-missing", "drive-fault", "following-error", "limit-switch", "enable-lost", "mode-lost", "not-homed"}
    named |= {"bus-lost", "emcy", "heartbeat-lost", "tpdo-missing", "boot-up", "nmt-change"}
    named |= {"gauge-out-of-range", "gauge-break", "gauge-frozen", "gauge-stuck", "gauge-unit"}
    assert set(FAULTS) == named
    assert all(kind.text for kind in FAULTS.values())


@pytest.mark.parametrize(
    ("spec", "says"),
    [
        ("drive-fault", "expected a node"),
        ("gauge-frozen:7", "expected no node, a fault of the gauge"),
        ("bus-lost:1", "expected no node, a fault of the bus"),
        ("earthquake:1", "no fault earthquake (expected one of node-missing, "),
        ("emcy:1=0xZZ", "expected KIND[:node][@time_s][=value]"),
        ("emcy:1=1.2.3", "1.2.3 cannot be parsed"),
    ],
)
def test_bad_specs_are_named(spec, says):
    with pytest.raises(InputError) as error:
        parse_fault(spec)
    assert f"--fault {spec}: " in str(error.value)
    assert says in str(error.value)
    assert "\n" not in str(error.value)
