// Builds elements. Text only ever goes in as text nodes, so a document cannot
// inject markup.

export function element(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== undefined && value !== null && value !== false) node.setAttribute(name, value);
  }
  node.append(...children.filter((child) => child !== undefined && child !== null));
  return node;
}

export const note = (section) => (section.note ? element('p', { class: 'note' }, section.note) : null);
