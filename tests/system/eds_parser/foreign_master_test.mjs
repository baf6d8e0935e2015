// Every drive with cyclic synchronous position, brought into motion by a CANopen master that
// somebody else wrote (npm: canopen) as docs/drives.md says, through the compensation node.
//
//   node foreign_master_test.mjs FOREIGN_BUS SOURCE_FOLDER

import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createInterface } from 'node:readline';
import Module, { createRequire } from 'node:module';
import test from 'node:test';

// Only block transfers need node-crc, which would have to be compiled; there are none here.
const load = Module._load;
Module._load = (name, ...rest) => (name === 'node-crc' ? {} : load(name, ...rest));
const require = createRequire(import.meta.url);
const Device = require('canopen/source/device.js');
const { Eds } = require('canopen/source/eds.js');
const { DataType } = require('canopen/source/types.js');
const [program, folder] = process.argv.slice(2);

const NODE = 32;
const DRIVES = [1, 2, 3];
const FORWARDED = 1; // 2034h
const OFF = 0x80000000; // bit 31 of a COB-ID
const SETTLE = 1500; // cycles: the correction comes softly

// The bus in another process; one question at a time.
class Bus {
  constructor(profile) {
    this.child = spawn(program, [profile], { stdio: ['pipe', 'pipe', 'inherit'] });
    this.lines = createInterface({ input: this.child.stdout })[Symbol.asyncIterator]();
    this.turn = Promise.resolve();
  }
  ask(line) {
    this.turn = this.turn.then(async () => {
      if (line) this.child.stdin.write(line + '\n');
      const answer = [];
      for (;;) {
        const { value, done } = await this.lines.next();
        assert.ok(!done, 'the bus has ended');
        if (value === '.') return answer;
        answer.push(value);
      }
    });
    return this.turn;
  }
  end() {
    this.child.stdin.end();
  }
}

class Master {
  constructor(bus) {
    this.bus = bus;
    this.actual = {};
    this.status = {};
    const eds = new Eds();
    for (const id of [...DRIVES, NODE]) eds.addSdoClientParameter(id, 0x600 | id, 0x580 | id);
    this.device = new Device({ id: 127, eds });
    this.device.sdo.start();
    this.device.on('message', ({ id, data }) => this.send(id, data));
  }
  take(answer) {
    for (const line of answer) {
      const [what, id, bytes] = line.split(' ');
      if (what === 'F') this.hear(parseInt(id, 16), Buffer.from(bytes ?? '', 'hex'));
    }
    return answer;
  }
  hear(id, data) {
    const drive = id - 0x180;
    if (DRIVES.includes(drive)) {
      this.actual[drive] = data.readInt32LE(0);
      this.status[drive] = data.readUInt16LE(4);
    } else if (id === 0x180 + NODE) {
      this.waits = (data.readUInt16LE(6) & 0x8000) !== 0;
    } else if (id > 0x580 && id < 0x600) {
      this.device.sdo.receive({ id, data });
    }
  }
  async send(id, data) {
    return this.take(await this.bus.ask(`F ${id.toString(16)} ${Buffer.from(data).toString('hex')}`));
  }
  async run(us) {
    return this.take(await this.bus.ask(`R ${us}`));
  }
  // --- SDO
  read(deviceId, index, subIndex, dataType) {
    return this.device.sdo.upload({ deviceId, index, subIndex, dataType, timeout: 5000 });
  }
  write(deviceId, index, subIndex, data, dataType) {
    return this.device.sdo.download({ deviceId, index, subIndex, data, dataType, timeout: 5000 });
  }
  // The order of docs/drives.md: off, type, inhibit time, nothing, entries, number, on.
  async map(drive, index, cob_id, type, entries, has_inhibit) {
    await this.write(drive, index, 1, (OFF | cob_id) >>> 0, DataType.UNSIGNED32);
    await this.write(drive, index, 2, type, DataType.UNSIGNED8);
    if (has_inhibit) await this.write(drive, index, 3, 0, DataType.UNSIGNED16);
    await this.write(drive, index + 0x200, 0, 0, DataType.UNSIGNED8);
    for (let i = 0; i < entries.length; ++i)
      await this.write(drive, index + 0x200, i + 1, entries[i], DataType.UNSIGNED32);
    await this.write(drive, index + 0x200, 0, entries.length, DataType.UNSIGNED8);
    await this.write(drive, index, 1, cob_id, DataType.UNSIGNED32);
  }
  // --- cycle
  async cycle(control, targets = this.place) {
    this.counter = ((this.counter ?? 0) % 240) + 1;
    let line = `C ${this.counts ? Buffer.from([this.counter]).toString('hex') : '-'}`;
    for (const [i, drive] of DRIVES.entries()) {
      const data = Buffer.alloc(6);
      data.writeUInt16LE(control);
      data.writeInt32LE(targets[i], 2);
      line += ` ${(0x200 + drive).toString(16)} ${data.toString('hex')}`;
    }
    return this.take(await this.bus.ask(line));
  }
  async cycles(count, control, targets) {
    for (let i = 0; i < count; ++i) await this.cycle(control, targets);
  }
  all(bits, mask) {
    return DRIVES.every((drive) => (this.status[drive] & mask) === bits);
  }
  async mode(mode) {
    for (const drive of DRIVES) await this.write(drive, 0x6060, 0, mode, DataType.INTEGER8);
  }
}

const entry = (index, bits, sub = 0) => (index * 0x10000 + sub * 0x100 + bits) >>> 0;
const CONTROL = entry(0x6040, 16), TARGET = entry(0x607a, 32), OFFSET_OF = entry(0x60b0, 32);
const ACTUAL = entry(0x6064, 32), STATUS = entry(0x6041, 16), PROBE = entry(0x60b9, 16);
const MODE = entry(0x6061, 8);

// 1006h and 1019h as far as the drive has them; the PDOs of its way; all others off.
async function configure(master, eds, drive, machine) {
  const has = (index, sub) => {
    const object = eds.getEntry(index);
    return object !== undefined && (sub === undefined || object[sub] !== undefined);
  };
  const inhibit = has(0x1800, 3);
  if (has(0x1006)) await master.write(drive, 0x1006, 0, 0, DataType.UNSIGNED32);
  if (has(0x1019)) await master.write(drive, 0x1019, 0, machine.counter, DataType.UNSIGNED8);
  if (has(0x1006)) await master.write(drive, 0x1006, 0, machine.period, DataType.UNSIGNED32);
  const forwarded = machine.way === FORWARDED;
  await master.map(drive, 0x1400, 0x200 + drive, 1, forwarded ? [CONTROL] : [CONTROL, TARGET]);
  await master.map(drive, 0x1401, 0x300 + drive, 1, forwarded ? [TARGET] : [OFFSET_OF]);
  const said = [ACTUAL, STATUS];
  if (forwarded) said.push(MODE);
  else if (has(0x60ba)) said.push(PROBE);
  await master.map(drive, 0x1800, 0x40000180 + drive, 1, said, inhibit);
  for (const [first, used] of [[0x1400, 2], [0x1800, 1]]) {
    for (let index = first + used; has(index); ++index) {
      const id = await master.read(drive, index, 1, DataType.UNSIGNED32);
      if (id < OFF) await master.write(drive, index, 1, (OFF + id) >>> 0, DataType.UNSIGNED32);
    }
  }
}

// A controller that has read the mapping back, or what the drive holds, tells the node.
async function tell_node(master, machine) {
  for (const [i, drive] of DRIVES.entries()) {
    if (machine.way === FORWARDED) {
      assert.equal(await master.read(drive, 0x1601, 1, DataType.UNSIGNED32), TARGET);
      await master.write(NODE, 0x2037, i + 1, 1, DataType.UNSIGNED8);
    } else {
      const held = await master.read(drive, 0x60b0, 0, DataType.INTEGER32);
      await master.write(NODE, 0x2206, i + 1, held, DataType.INTEGER32);
    }
  }
}

// Enabled, homed, then in cyclic synchronous position; the target is 6064h without the offset.
async function enable(master) {
  await master.mode(6);
  for (const control of [0x06, 0x07]) await master.cycles(5, control);
  for (let i = 0; i < 500 && master.waits !== false; ++i) await master.cycle(0x07);
  assert.equal(master.waits, false, 'bit 15 of 2600h:03');
  await master.cycles(2, 0x07);
  await master.cycles(5, 0x0f);
  assert.ok(master.all(0x27, 0x6f), 'operation enabled');
  await master.cycles(5, 0x1f);
  assert.ok(master.all(0x100, 0x100), 'referenced');
  await master.mode(8);
  await master.cycles(5, 0x0f);
}

async function run(profile, master) {
  const eds = Eds.fromFile(`${folder}/host_sim/drives/${profile}.eds`);
  const [first] = await master.bus.ask('');
  const [, way, period, counter, ...place] = first.split(' ').map(Number);
  const machine = { way, period, counter };
  master.place = place; // 6064h without an offset
  master.counts = counter !== 0;
  for (const drive of DRIVES) {
    for (const sub of [1, 2]) {
      const identity = eds.getEntry(0x1018)?.[sub];
      if (identity?.value)
        assert.equal(await master.read(drive, 0x1018, sub, DataType.UNSIGNED32), identity.value);
    }
    assert.equal((await master.read(drive, 0x1000, 0, DataType.UNSIGNED32)) & 0xffff, 402);
    await configure(master, eds, drive, machine);
  }
  for (const id of [...DRIVES, NODE]) master.device.nmt.startNode(id);
  await master.run(1000);
  await master.cycles(5, 0);
  await tell_node(master, machine);
  await enable(master);
  await master.cycles(SETTLE, 0x0f, place);
  // Away and back: the correction depends on where an axis comes from.
  for (let i = 1; i <= 20; ++i) await master.cycle(0x0f, place.map((p) => p + 50 * i));
  for (let i = 20; i >= 0; --i) await master.cycle(0x0f, place.map((p) => p + 50 * i));
  await master.cycles(SETTLE, 0x0f, place);
  assert.ok(master.all(0x27, 0x6f), 'still enabled');
  // 6064h contains the offset (docs/drives.md).
  const expected = (await master.bus.ask('E'))[0].split(' ').slice(1).map(Number);
  for (const [i, drive] of DRIVES.entries()) {
    const residual = master.actual[drive] - place[i] - expected[i];
    assert.ok(Math.abs(residual) <= 1.5, `drive ${drive}: ${residual} units left`);
  }
  assert.ok(expected.some((offset) => Math.abs(offset) > 10), 'there is something to correct');
}

for (const profile of ['elmo_gold', 'epos4_0150', 'epos4_0170', 'nanotec_cl4e',
                       'trinamic_tmcm1270', 'novanta_eve_net_c', 'eyou'])
  test(profile, async () => {
    const bus = new Bus(profile);
    try {
      await run(profile, new Master(bus));
    } finally {
      bus.end();
    }
  });
