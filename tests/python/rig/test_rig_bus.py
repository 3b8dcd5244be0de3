"""The rig over real socketcand frames: SDO, PDO re-mapping, NMT, motion, supervision."""

from __future__ import annotations

import signal
import struct
import time

import can
import pytest
from canopen.sdo import SdoAbortedError

GAUGE, DRIVES = 7, range(1, 7)
BOOT_UP, PRE_OPERATIONAL, OPERATIONAL = 0x00, 0x7F, 0x05
POSITION, VELOCITY, STATUSWORD, MODE = 0x60640020, 0x606C0020, 0x60410010, 0x60610008


def test_nodes_answer_with_identity_and_long_strings(start):
    controller = start()
    controller.talk()
    for node, device in controller.nodes.items():
        profile = 404 if node == GAUGE else 402
        assert device.sdo[0x1000].raw & 0xFFFF == profile
        assert device.sdo[0x1018][4].raw == node
        assert "simulated CiA" in device.sdo[0x1008].raw  # longer than four bytes: a segmented transfer
    assert controller.nodes[GAUGE].sdo[0x6131][1].raw == 0xFA010000


@pytest.mark.parametrize(
    ("index", "subindex", "data", "code"),
    [
        (0x5FFF, 0, b"\0", 0x06020000),
        (0x1018, 9, b"\0", 0x06090011),
        (0x6041, 0, b"\0\0", 0x06010002),
        (0x6040, 0, b"\0", 0x06070010),
        (0x605A, 0, b"\x09\0", 0x06090031),
        (0x6060, 0, b"\x01", 0x06090030),
    ],
)
def test_bad_downloads_are_aborted_with_their_code(start, index, subindex, data, code):
    controller = start()
    controller.talk()
    with pytest.raises(SdoAbortedError) as aborted:
        controller.nodes[1].sdo.download(index, subindex, data)
    assert aborted.value.code == code


def test_remapped_tpdo_is_what_travels(start):
    controller = start()
    controller.talk()
    node = controller.nodes[2]
    node.tpdo.read()
    assert [(v.index, v.length) for v in node.tpdo[1].map] == [(0x6041, 16), (0x6064, 32), (0x6061, 8)]
    node.tpdo[1].clear()
    for index in (0x6064, 0x606C):
        node.tpdo[1].add_variable(index)
    node.tpdo[1].save()
    assert [node.sdo[0x1A00][k].raw for k in range(3)] == [2, POSITION, VELOCITY]
    position = node.sdo[0x6064].raw
    controller.nmt(0x01)
    controller.loop()
    controller.frame(0x80)
    message = controller.receive(lambda m: m.arbitration_id == 0x182)
    assert struct.unpack("<ii", message.data) == (position, 0)


def test_mapping_out_of_order_is_refused(start):
    controller = start()
    controller.talk()
    sdo = controller.nodes[1].sdo

    def code(index: int, subindex: int, value: int) -> int:
        with pytest.raises(SdoAbortedError) as aborted:
            sdo[index][subindex].raw = value
        return aborted.value.code

    assert code(0x1A00, 0, 0) == 0x06010002  # the PDO is still valid
    sdo[0x1800][1].raw = 0xC0000181
    assert code(0x1A00, 1, POSITION) == 0x06010002  # sub-index 0 is not 0 yet
    sdo[0x1A00][0].raw = 0
    assert code(0x1A00, 1, 0x60650020) == 0x06040041  # not mappable
    for subindex, entry in enumerate((POSITION, VELOCITY, MODE), start=1):
        sdo[0x1A00][subindex].raw = entry
    assert code(0x1A00, 0, 3) == 0x06040042  # nine bytes
    sdo[0x1A00][0].raw = 2
    sdo[0x1800][1].raw = 0x40000181
    controller.nmt(0x01)
    assert code(0x1800, 1, 0xC0000181) == 0x08000022


def test_reset_boots_every_node_and_start_makes_it_operational(start):
    controller = start()
    controller.nmt(0x81)
    booted = {controller.receive(lambda m: m.arbitration_id > 0x700).arbitration_id - 0x700 for _ in range(7)}
    assert booted == set(controller.nodes)
    controller.talk()
    for node in controller.nodes.values():
        node.sdo[0x1017].raw = 20
    controller.nmt(0x01)
    controller.loop()
    states = {}
    while set(states.values()) != {OPERATIONAL} or len(states) < 7:
        message = controller.receive(lambda m: m.arbitration_id > 0x700)
        states[message.arbitration_id - 0x700] = message.data[0]


def test_drives_follow_targets_and_enabling_moves_nothing(start):
    controller = start()
    at = controller.ready()
    before = controller.cycle(0x0F, at)
    assert all(word & 0x006F == 0x0027 and word & 0x1000 for word in controller.statuswords(before))
    assert [struct.unpack_from("<i", before[n], 2)[0] for n in DRIVES] == at
    for step in range(1, 201):
        targets = [count + 50 * step for count in at]
        controller.cycle(0x0F, targets)
    for _ in range(20):
        after = controller.cycle(0x0F, targets)
    assert [struct.unpack_from("<i", after[n], 2)[0] for n in DRIVES] == targets


def test_jump_on_enable_is_refused_by_a_fault(start):
    controller = start()
    controller.configure()
    at = controller.positions()
    controller.nmt(0x01)
    away = [at[0] + 50_000, *at[1:]]
    controller.enable(away)
    words = controller.statuswords(controller.cycle(0x0F, away))
    assert words[0] & 0x004F == 0x0008
    assert controller.emergencies(1) == [0x8611]
    assert all(word & 0x006F == 0x0027 for word in words[1:])
    assert controller.positions() == at


def test_software_limit_and_rate_limit_show_as_internal_limit(start):
    controller = start()
    controller.configure()
    at = controller.positions()
    controller.talk()
    controller.nodes[1].sdo[0x607D][1].raw = at[0] - 1000
    controller.nodes[2].sdo[0x607F].raw = 1000
    controller.nmt(0x01)
    controller.enable(at)
    targets = [at[0] - 2000, at[1] + 2000, *at[2:]]
    for _ in range(2):
        answers = controller.cycle(0x0F, targets)
    words = controller.statuswords(answers)
    assert [bool(word & 0x0800) for word in words] == [True, True, False, False, False, False]
    for _ in range(30):
        answers = controller.cycle(0x0F, targets)
    assert struct.unpack_from("<i", answers[1], 2)[0] == at[0] - 1000


def _reading_run(start, truth: str, pause_s: float) -> list[dict[int, bytes]]:
    controller = start("--truth", truth)
    controller.mount(ball_mm=(100.0, 0.0, 80.0))  # cup at z 340, platform at 260: the bar lies flat
    at = controller.ready()
    samples = []
    for step in range(150):
        if step % 50 == 0:
            time.sleep(pause_s)
        samples.append(controller.cycle(0x0F, [count + 20 * step * (k in (2, 3)) for k, count in enumerate(at)]))
    return samples


def test_samples_depend_on_the_truth_and_not_on_the_clock(start, truth_file):
    truth = truth_file("seed = 5\n[geometry]\nleg_length_um = [10, -20, 30, -40, 50, -60]\n")
    fast, slow = _reading_run(start, truth, 0.0), _reading_run(start, truth, 0.05)
    assert fast == slow
    readings = [struct.unpack("<fB", sample[GAUGE]) for sample in fast]
    assert all(status == 0 for _, status in readings)
    assert len({value for value, _ in readings}) > 50


def test_unmounted_and_far_bars_read_not_valid(start):
    controller = start()
    at = controller.ready()
    assert struct.unpack("<fB", controller.cycle(0x0F, at)[GAUGE]) == (0.0, 1)
    controller.mount(ball_mm=(0.0, 0.0, 60.0))  # 20 mm from the cup: the bar is 100 mm
    controller.loop()
    assert struct.unpack("<fB", controller.cycle(0x0F, at)[GAUGE]) == (-1000.0, 5)
    controller.mount(ball_mm=(110.0, 0.0, 60.0))
    controller.loop()
    assert struct.unpack("<fB", controller.cycle(0x0F, at)[GAUGE]) == (1000.0, 3)


def test_lost_controller_heartbeat_stops_the_drives(start):
    controller = start("--stall-tolerance", "0")
    controller.configure()
    at = controller.positions()
    for node in DRIVES:
        controller.nodes[node].sdo[0x1016][1].raw = 127 << 16 | 200
    controller.nmt(0x01)
    controller.loop()
    controller.frame(0x700 + 127, bytes([OPERATIONAL]))
    controller.enable(at)
    for node in DRIVES:
        message = controller.receive(lambda m, node=node: m.arbitration_id == 0x80 + node)
        assert struct.unpack_from("<H", message.data)[0] == 0x8130
    controller.talk()
    assert all(controller.nodes[node].sdo[0x6041].raw & 0x006F == 0x0040 for node in DRIVES)


def test_sync_without_targets_trips_the_rpdo_deadline(start):
    controller = start()
    controller.configure()
    at = controller.positions()
    for node in DRIVES:
        controller.nodes[node].sdo[0x1400][5].raw = 40
    controller.nmt(0x01)
    controller.enable(at)
    for _ in range(12):
        controller.frame(0x80)
    for node in DRIVES:
        message = controller.receive(lambda m, node=node: m.arbitration_id == 0x80 + node)
        assert struct.unpack_from("<H", message.data)[0] == 0x8250


def test_drives_stop_and_say_where_when_the_controller_vanishes(rig_process, connect):
    with rig_process("--once") as (port, process):
        controller = connect(port)
        at = controller.ready()
        for step in range(1, 51):
            controller.cycle(0x0F, [count + 400 * step for count in at])
        controller.close()
        _, said = process.communicate(timeout=20.0)
        assert process.returncode == 0
    for node in DRIVES:
        assert f"node {node}: no client on the bus, stopping at" in said
        assert f"node {node}: stopped at" in said
    assert said.count("SWITCH_ON_DISABLED") == 6


def test_ends_on_sigterm_and_speaks_only_its_one_line(rig_process):
    with rig_process() as (_, process):
        process.send_signal(signal.SIGTERM)
        out, _ = process.communicate(timeout=20.0)
        assert process.returncode == 0
        assert out == ""


def test_ctrl_c_leaves_the_bus_to_the_controller_until_it_has_gone(rig_process, connect):
    with rig_process() as (port, process):
        controller = connect(port)
        at = controller.ready()
        process.send_signal(signal.SIGINT)
        time.sleep(0.2)
        words = controller.statuswords(controller.cycle(0x02, at))
        assert all(word & 0x006F == 0x0027 for word in words)
        assert all(word & 0x006F == 0x0040 for word in controller.statuswords(controller.cycle(0x00, at)))
        controller.close()
        assert process.wait(20.0) == 0


def test_ctrl_c_without_a_controller_ends_at_once(rig_process):
    with rig_process() as (_, process):
        process.send_signal(signal.SIGINT)
        assert process.wait(20.0) == 0


def test_two_clients_share_one_bus(rig_process, connect):
    with rig_process() as (port, _):
        first, second = connect(port), connect(port)
        try:
            first.talk()
            assert first.nodes[1].sdo[0x1000].raw & 0xFFFF == 402
            first.loop()
            time.sleep(0.1)  # beyond the silence after the handshake
            first.frame(0x123, b"\x01\x02")
            message = second.receive(lambda m: m.arbitration_id == 0x123)
            assert bytes(message.data) == b"\x01\x02"
        finally:
            first.close()
            second.close()


def test_bus_speaks_to_python_can_alone(rig_process):
    with (
        rig_process() as (port, _),
        can.Bus(interface="socketcand", channel="can0", host="127.0.0.1", port=port, tcp_tune=True) as bus,
    ):
        bus.send(can.Message(arbitration_id=0x000, data=[0x81, 0x03], is_extended_id=False))
        message = bus.recv(20.0)
        assert (message.arbitration_id, bytes(message.data)) == (0x703, bytes([BOOT_UP]))
