// The table of a large report: rows are data, of which one page at a time is shown. Texts are only ever inserted as
// text nodes.
'use strict';
(() => {
  const $ = (selector) => document.querySelector(selector);
  const make = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  const settings = JSON.parse($('#settings').textContent);
  const [NAME, VERDICT, POINTS, REASON, ALGORITHM, PRECISION, TOOLCHAIN, OWNER, INDEX] = Array(9).keys();

  for (const time of document.querySelectorAll('time')) {
    time.title = time.textContent;
    time.textContent = new Date(time.dateTime).toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });
  }

  // The rows are parsed when they are first needed, after the first page is shown.
  let rows = null;
  const all = () => {
    if (rows) return rows;
    rows = [];
    for (const element of document.querySelectorAll('script.rows')) {
      for (const row of JSON.parse(element.textContent)) {
        row.push(rows.length);
        rows.push(row);
      }
      element.remove();
    }
    return rows;
  };

  const format = new Intl.NumberFormat('en-US');
  const addressOf = (index) => {
    const part = Math.floor(index / settings.page) + 1;
    return `${settings.parts}/${String(part).padStart(4, '0')}.html#s${index % settings.page}`;
  };
  // What is between backticks is code.
  const sentence = (text) => {
    const parts = text.split('`');
    return parts.length % 2 ? parts.map((part, at) => (at % 2 ? make('code', { textContent: part }) : part)) : [text];
  };
  const checkOf = (differing) => {
    const textContent = differing === null ? 'not run' : format.format(differing);
    return make('td', { className: `number wide${differing ? '' : ' none'}`, textContent });
  };
  const rowOf = (row) => {
    const name = make('th', { scope: 'row' }, make('a', { href: addressOf(row[INDEX]), textContent: row[NAME] }));
    if (row[OWNER] !== null) name.append(make('br'), make('span', { className: 'more', textContent: row[OWNER] }));
    const verdict = settings.verdicts[row[VERDICT]];
    const cells = [name, make('td', {}, make('span', { className: `verdict ${verdict}`, textContent: verdict }))];
    if (settings.hasPoints) cells.push(make('td', { className: 'number', textContent: row[POINTS]?.join(' of ') ?? '' }));
    cells.push(make('td', { className: 'why' }, ...sentence(row[REASON])));
    cells.push(...[ALGORITHM, PRECISION, TOOLCHAIN].map((check) => checkOf(row[check])));
    return make('tr', {}, ...cells);
  };

  // Numbers in texts are sorted by their values: `a2` is before `a10`.
  const padded = (text) => text.toLowerCase().replace(/\d+/g, (digits) => digits.padStart(12, '0'));
  const keyOf = (row, column) => {
    if (column === NAME || column === REASON) return padded(row[column]);
    return (column === POINTS ? row[POINTS]?.[0] : row[column]) ?? -1;
  };
  let sorted = null;
  const heads = [...document.querySelectorAll('#shaders thead [data-sort]')];
  const sort = (head) => {
    const down = head.getAttribute('aria-sort') === 'ascending';
    for (const other of heads) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const column = Number(head.dataset.sort);
    const keyed = all().map((row) => [keyOf(row, column), row]);
    const order = (a, b) => (a[0] < b[0] ? -1 : a[0] > b[0] ? 1 : 0);
    // The sort is stable: rows that are equal in this column keep their order.
    keyed.sort(down ? (a, b) => order(b, a) : order);
    sorted = keyed.map(([, row]) => row);
    filter();
  };
  for (const head of heads) {
    head.replaceChildren(make('button', { type: 'button', textContent: head.textContent, onclick: () => sort(head) }));
  }

  // The rows that the form selects, of which one page is shown.
  const form = $('#filter');
  let selected = [];
  let page = 0;
  const pages = () => Math.max(1, Math.ceil(selected.length / settings.visible));
  const turnButton = (text, by) => make('button', { type: 'button', textContent: text, onclick: () => show(page + by) });
  const [previous, next] = [turnButton('Previous', -1), turnButton('Next', 1)];
  const place = make('span', { role: 'status' });
  form.append(make('p', { className: 'pages' }, previous, ' ', place, ' ', next));
  const show = (number) => {
    page = number;
    const visible = selected.slice(page * settings.visible, (page + 1) * settings.visible);
    $('#shaders tbody').replaceChildren(...visible.map(rowOf));
    place.textContent = `page ${format.format(page + 1)} of ${format.format(pages())}`;
    [previous.disabled, next.disabled] = [page === 0, page === pages() - 1];
    $('#shown').textContent = `${format.format(selected.length)} of ${format.format(all().length)} shown`;
  };
  const filter = () => {
    const sought = form.words.value.trim().toLowerCase();
    const checked = form.querySelectorAll('[name=verdict]:checked');
    const verdicts = new Set([...checked].map((box) => box.value));
    const has = (text) => text !== null && text.toLowerCase().includes(sought);
    const matches = (row) => sought === '' || has(row[NAME]) || has(row[REASON]) || has(row[OWNER]);
    selected = (sorted ?? all()).filter((row) => verdicts.has(settings.verdicts[row[VERDICT]]) && matches(row));
    show(0);
  };
  form.addEventListener('input', filter);
  form.addEventListener('submit', (event) => event.preventDefault());
  form.hidden = false;
  requestAnimationFrame(() => setTimeout(filter));
})();
