// No label of a chart is printed over another.

const TOUCHING = 0.5;  // pixels
const LEADING = 0.15;  // of the height of a box, above and below what is printed

// Corners of every text as drawn, turned ones too, in pixels of the page.
const LABELS = `[...document.querySelectorAll('.chart')].map((chart) => [...chart.querySelectorAll('svg text')]
  .filter((text) => text.textContent.trim() !== '' && getComputedStyle(text).visibility !== 'hidden')
  .map((text) => {
    const { x, y, width, height } = text.getBBox();
    const matrix = text.getScreenCTM();
    const at = (dx, dy) => { const p = new DOMPoint(x + dx, y + dy).matrixTransform(matrix); return [p.x, p.y]; };
    const [top, bottom] = [${LEADING} * height, (1 - ${LEADING}) * height];
    return { words: text.textContent, corners: [at(0, top), at(width, top), at(width, bottom), at(0, bottom)] };
  }))`;

// How far two convex boxes reach into each other along a direction; 0 or less: apart.
function overlapAlong([dx, dy], a, b) {
  const ends = (corners) => {
    const places = corners.map(([x, y]) => x * dx + y * dy);
    return [Math.min(...places), Math.max(...places)];
  };
  const [aLow, aHigh] = ends(a);
  const [bLow, bHigh] = ends(b);
  return Math.min(aHigh, bHigh) - Math.max(aLow, bLow);
}

// Separating axes of two rectangles are the directions of their sides.
export function overprint(a, b) {
  const sides = [a, b].flatMap((corners) => [[corners[0], corners[1]], [corners[1], corners[2]]]);
  return Math.min(...sides.map(([[x0, y0], [x1, y1]]) => {
    const length = Math.hypot(x1 - x0, y1 - y0) || 1;
    return overlapAlong([(x1 - x0) / length, (y1 - y0) / length], a, b);
  }));
}

// Returns the number of labels looked at.
export async function checkLabels(page, failures, charts, where) {
  const all = await page.value(LABELS);
  for (const [index, labels] of all.entries()) {
    for (const [i, a] of labels.entries()) {
      for (const b of labels.slice(i + 1)) {
        const reach = overprint(a.corners, b.corners);
        failures.check(reach <= TOUCHING, `${where}: "${a.words}" and "${b.words}" overprint each other by ${reach.toFixed(1)} pixels in "${charts[index].title}"`);
      }
    }
  }
  return all.flat().length;
}
