// The EDS of the compensation node, read with a parser somebody else wrote (npm: canopen).
//
//   node eds_test.mjs firmware/volcomp.eds

import assert from 'node:assert/strict';
import test from 'node:test';
import eds_module from 'canopen/source/eds.js';
import types from 'canopen/source/types.js';

const { Eds } = eds_module;
const { DataType, ObjectType } = types;
const eds = Eds.fromFile(process.argv[2]);

const mapped = (index) => {
  const object = eds.getEntry(index);
  const entries = [];
  for (let sub = 1; sub <= object[0].value; ++sub) {
    if (object[sub].value !== 0) entries.push(object[sub].value.toString(16).padStart(8, '0'));
  }
  return entries;
};

const name_of_mapping = (mapping) => {
  const value = parseInt(mapping, 16);
  return eds.getEntry(value >>> 16)[(value >>> 8) & 0xff].parameterName;
};

test('device information', () => {
  assert.equal(eds.deviceInfo.ProductName, 'volcomp compensation');
  assert.equal(eds.deviceInfo.NrOfRXPDO, '27');
  assert.equal(eds.deviceInfo.NrOfTXPDO, '9');
  assert.equal(eds.deviceInfo.Granularity, '8');
});

test('identity (1018h)', () => {
  const identity = eds.getEntry(0x1018);
  assert.equal(identity.objectType, ObjectType.RECORD);
  assert.equal(identity[2].parameterName, 'Product code');
  assert.equal(identity[2].value, 0x564f4c43); // "VOLC"
});

test('types, access and defaults', () => {
  const expected = [
    // index, sub, type, access, default
    [0x1005, null, DataType.UNSIGNED32, 'rw', 0x80],
    [0x1012, null, DataType.UNSIGNED32, 'ro', 0x80000100],
    [0x1017, null, DataType.UNSIGNED16, 'rw', 100],
    [0x1019, null, DataType.UNSIGNED8, 'rw', 240],
    [0x2011, 1, DataType.INTEGER32, 'rww', 0],
    [0x2020, 5, DataType.INTEGER32, 'ro', 0],
    [0x2033, 1, DataType.UNSIGNED16, 'rw', 0x100],
    [0x2112, 4, DataType.INTEGER16, 'ro', -1],
    [0x2201, 3, DataType.INTEGER32, 'rw', 200000],
    [0x2205, 1, DataType.INTEGER64, 'rw', 0n],
    [0x2303, 1, DataType.REAL64, 'rw', 0], // without a default: this parser takes 0
    [0x2600, 0xb, DataType.UNSIGNED8, 'ro', 0],
    [0x2700, 1, DataType.INTEGER16, 'rww', -32768],
    [0x2702, 2, DataType.UNSIGNED16, 'rw', 60],
  ];
  for (const [index, sub, type, access, value] of expected) {
    const object = sub === null ? eds.getEntry(index) : eds.getEntry(index)[sub];
    const place = `${index.toString(16)}h:${sub}`;
    assert.equal(object.dataType, type, place);
    assert.equal(object.accessType, access, place);
    assert.equal(object.value, value, place);
  }
});

test('limits', () => {
  const limit = eds.getEntry(0x2201)[1];
  assert.equal(limit.lowLimit, 1);
  assert.equal(limit.highLimit, 4194303);
  assert.equal(eds.getEntry(0x2206)[1].lowLimit, -1073741824);
});

test('the table image (2110h:01) is a domain', () => {
  assert.equal(eds.getEntry(0x2110)[1].objectType, ObjectType.DOMAIN);
  assert.equal(eds.getEntry(0x2110)[1].dataType, DataType.DOMAIN);
});

test('RPDO 1 carries control word and target of axis 1', () => {
  assert.deepEqual(mapped(0x1600), ['20120110', '20110120']);
  assert.deepEqual(mapped(0x1600).map(name_of_mapping), [
    'Control word (axis 1)',
    'Target position (axis 1)',
  ]);
  assert.equal(eds.getEntry(0x1400)[1].value, 0x80000200); // not valid without a drive
  assert.equal(eds.getEntry(0x1400)[2].value, 254);
});

test('TPDO 1 carries the offset of axis 1', () => {
  assert.deepEqual(mapped(0x1a00), ['20200120']);
  assert.deepEqual(mapped(0x1a00).map(name_of_mapping), ['Offset to the drive (axis 1)']);
});

test('TPDO 6 carries CRC, state, SYNC counter and status bits', () => {
  assert.deepEqual(mapped(0x1a05), ['21120720', '26000108', '26000208', '26000310']);
  assert.equal(eds.getEntry(0x1805)[1].defaultValue, '$NODEID+0x40000180');
});

test('SDO server (1200h)', () => {
  assert.equal(eds.getEntry(0x1200)[1].defaultValue, '$NODEID+0x600');
  assert.equal(eds.getEntry(0x1200)[2].defaultValue, '$NODEID+0x580');
});
