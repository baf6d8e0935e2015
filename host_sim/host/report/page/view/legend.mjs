// Buttons that switch series on and off; one legend serves a chart or a whole group.

import { element } from './dom.mjs';

// colours is called again whenever the theme changes; onChange gets the hidden names.
export function makeLegend(entries, onChange) {
  const hidden = new Set();
  const swatches = new Map();
  const buttons = entries.map(({ name, look }) => {
    const swatch = element('i', { class: `swatch ${look}` });
    swatches.set(name, swatch);
    const button = element('button', { type: 'button', 'aria-pressed': 'true' }, swatch, name);
    button.addEventListener('click', () => {
      if (!hidden.delete(name)) hidden.add(name);
      button.setAttribute('aria-pressed', String(!hidden.has(name)));
      onChange();
    });
    return button;
  });
  return {
    node: element('div', { class: 'legend', role: 'group', 'aria-label': 'Series' }, ...buttons),
    hidden,
    paint: (theme) => swatches.forEach((swatch, name) => swatch.style.setProperty('--swatch', theme.colourOf(name))),
  };
}
