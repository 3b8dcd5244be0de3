// Six drives and a gauge on a stack that is not ours: the npm package `canopen` (node-canopen), over socketcand.
//
// The stack does everything of CiA 301: NMT, SDO server, PDO mapping, SYNC, heartbeat. Added here is the least of an
// application: drives that are in the state they are commanded to and stand at their targets, a gauge that reads a sine.
//
// node nodes.js PORT FOLDER COUNTS...: nodeN.eds in FOLDER, where `$NODEID` has its value; start positions of the drives.
'use strict';
const net = require('net');
const { Device, Eds } = require('canopen');

const [, , port, folder, ...counts] = process.argv;
const GAUGE = 7;
const SYNC = 0x80;
const HOMED = 0x8000;
const SETTLE_MS = 60; // the server sends nothing to a client that has only just connected
const STATUSWORDS = { 0x00: 0x240, 0x80: 0x240, 0x06: 0x221, 0x07: 0x223, 0x0f: 0x1227, 0x02: 0x207 };

const nodes = [1, 2, 3, 4, 5, 6, GAUGE].map((id) => ({
    id,
    device: new Device({ eds: Eds.fromFile(`${folder}/node${id}.eds`), id }),
}));
const socket = net.connect(Number(port), '127.0.0.1');
socket.setNoDelay(true);

function send({ id, data }) {
    const bytes = Array.from(data || []);
    const text = bytes.map((byte) => byte.toString(16)).join(' ');
    socket.write(`< send ${id.toString(16).padStart(3, '0')} ${bytes.length.toString(16)} ${text} >`);
    if (id > SYNC && id < 0x100) console.log(`EMCY ${id.toString(16)} ${Buffer.from(bytes).toString('hex')}`);
}

function apply({ id, device }, instant) {
    if (id === GAUGE) {
        device.setValueArray(0x6130, 1, 50.0 * Math.sin(instant / 100.0));
        return;
    }
    const controlword = device.getValue(0x6040);
    if (controlword in STATUSWORDS) device.setValue(0x6041, HOMED | STATUSWORDS[controlword]);
    if (controlword === 0x0f) device.setValue(0x6064, device.getValue(0x607a));
    device.setValue(0x6061, device.getValue(0x6060));
}

function start() {
    for (const { id, device } of nodes) {
        device.addListener('message', send);
        if (id !== GAUGE) {
            device.setValue(0x6041, HOMED | STATUSWORDS[0]);
            device.setValue(0x6064, Number(counts[id - 1]));
        }
        device.start();
    }
    console.log('started');
}

let text = '';
let answers = 0;
let syncs = 0;
socket.on('data', (chunk) => {
    const messages = (text + chunk.toString('latin1')).split('>');
    text = messages.pop();
    for (const [, verb, id, , hex] of messages.map((message) => message.trim().split(/\s+/))) {
        if (verb === 'hi') socket.write('< open can0 >');
        if (verb === 'ok') answers++ ? setTimeout(start, SETTLE_MS) : socket.write('< rawmode >');
        if (verb !== 'frame') continue;
        const frame = { id: parseInt(id, 16), data: Buffer.from(hex || '', 'hex') };
        if (frame.id === SYNC) syncs++;
        for (const node of nodes) {
            node.device.receive({ ...frame, len: frame.data.length });
            if (frame.id === SYNC) apply(node, syncs); // after the TPDO, like every other node
        }
    }
});
socket.on('close', () => process.exit(0));
