// The behavior of the page where scripts run. Shader texts are only ever inserted as text nodes.
'use strict';
(() => {
  const $ = (selector, within = document) => within.querySelector(selector);
  const $$ = (selector, within = document) => [...within.querySelectorAll(selector)];
  const make = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  const settings = JSON.parse($('#settings').textContent);
  const STEP = settings.step;

  // The table: sorted by a click on a column header, filtered by text and verdicts.

  const body = $('#shaders tbody');
  const rows = [...body.rows];
  const form = $('#filter');
  const heads = $$('#shaders thead th');
  const words = new Intl.Collator(undefined, { numeric: true });

  const valueOf = (row, column) => {
    const by = row.cells[column].dataset.by;
    return by === undefined ? row.cells[column].textContent : Number(by);
  };
  const sort = (column) => {
    const down = heads[column].getAttribute('aria-sort') === 'ascending';
    heads.forEach((head) => head.removeAttribute('aria-sort'));
    heads[column].setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const order = (a, b) => {
      const [left, right] = [valueOf(a, column), valueOf(b, column)];
      return typeof left === 'number' ? left - right : words.compare(left, right);
    };
    // The sort is stable: rows that are equal in this column keep their order.
    const sorted = [...rows].sort((a, b) => (down ? -order(a, b) : order(a, b)) || rows.indexOf(a) - rows.indexOf(b));
    body.append(...sorted);
    moves();
  };
  heads.forEach((head, column) => {
    const button = make('button', { type: 'button', textContent: head.textContent });
    button.addEventListener('click', () => sort(column));
    head.replaceChildren(button);
  });

  const filter = () => {
    const sought = form.words.value.trim().toLowerCase();
    const verdicts = new Set($$('[name=verdict]:checked', form).map((box) => box.value));
    let shown = 0;
    for (const row of rows) {
      row.hidden = !verdicts.has(row.dataset.verdict) || !row.textContent.toLowerCase().includes(sought);
      shown += row.hidden ? 0 : 1;
    }
    $('#shown').textContent = `${shown} of ${rows.length} shown`;
    moves();
  };
  form.addEventListener('input', filter);
  form.addEventListener('submit', (event) => event.preventDefault());
  form.hidden = false;

  // One shader.

  let open = null;
  const buttons = {
    back: make('button', { type: 'button', textContent: 'Back to all' }),
    previous: make('button', { type: 'button', textContent: 'Previous' }),
    next: make('button', { type: 'button', textContent: 'Next' }),
  };
  const bar = make('nav', { className: 'moves', ariaLabel: 'Shaders' }, ...Object.values(buttons));

  const linkOf = (article) => $(`#shaders a[href="#${article.id}"]`);
  const neighbour = (by) => {
    const shown = [...body.rows].filter((row) => !row.hidden);
    const at = shown.indexOf(linkOf(open).closest('tr'));
    return at < 0 ? undefined : shown[at + by];
  };
  function moves() {
    if (open) {
      buttons.previous.disabled = !neighbour(-1);
      buttons.next.disabled = !neighbour(1);
    }
  }
  const go = (by) => {
    const row = neighbour(by);
    if (row) location.hash = $('a', row).hash;
  };
  const close = () => {
    const link = linkOf(open);
    location.hash = '';
    // The table must be visible again before it can be focused.
    show();
    link.focus();
  };
  buttons.previous.addEventListener('click', () => go(-1));
  buttons.next.addEventListener('click', () => go(1));
  buttons.back.addEventListener('click', close);
  document.addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && open) close();
  });

  const show = () => {
    if (open) {
      open.classList.remove('open');
      $('.viewer', open)?.remove();
      linkOf(open).closest('tr').classList.remove('open');
      linkOf(open).removeAttribute('aria-current');
    }
    open = /^#s\d+$/.test(location.hash) ? document.getElementById(location.hash.slice(1)) : null;
    $('main').classList.toggle('reading', open !== null);
    if (!open) return;
    open.classList.add('open');
    open.prepend(bar);
    linkOf(open).closest('tr').classList.add('open');
    linkOf(open).setAttribute('aria-current', 'true');
    moves();
    if (open.dataset.actual !== undefined) view(open);
    $('h2', open).focus({ preventScroll: true });
    if (getComputedStyle($('#articles')).position === 'sticky') $('#articles').scrollTop = 0;
    else scrollTo(0, 0);
  };
  addEventListener('hashchange', show);

  // The images of a shader.

  /** The pixels of an image's upper left part of the given size; of the whole image without a size. */
  const pixels = async (place, size) => {
    const image = new Image();
    image.src = `data:image/png;base64,${document.getElementById(`p${place}`).textContent}`;
    await image.decode();
    const [width, height] = size ?? [image.naturalWidth, image.naturalHeight];
    const canvas = make('canvas', { width, height });
    const context = canvas.getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, width, height);
  };

  const colourOf = (picture, at) => [...picture.data.subarray(4 * at, 4 * at + 3)];
  const differenceOf = (a, b) => Math.max(...a.map((value, part) => Math.abs(value - b[part])));
  /** The legend's colors for magnitudes, the largest first. */
  const bands = settings.eye.filter(([name]) => name.startsWith('>')).reverse();
  /** The color of a difference in 8-bit levels. */
  const heat = Array.from({ length: 256 }, (_, levels) => {
    const band = bands.find(([name]) => levels / 255 > Number(name.slice(2)));
    return [...(band ? band[1] : [0, 0, 0]), 255];
  });
  const heatMap = (reference, actual) => {
    const [map, a, b] = [new ImageData(actual.width, actual.height), reference.data, actual.data];
    for (let at = 0; at < a.length; at += 4) {
      const parts = [0, 1, 2].map((part) => Math.abs(a[at + part] - b[at + part]));
      map.data.set(heat[Math.max(...parts)], at);
    }
    return map;
  };
  const swatch = (colour) => {
    const box = make('span', { className: 'swatch', ariaHidden: 'true' });
    box.style.backgroundColor = `rgb(${colour})`;
    return box;
  };

  const QUESTIONS = ['maths', 'rounding', 'toolchain'];
  const legendOf = (name) => (name === 'toolchain' ? settings.bits : settings.eye);

  async function view(article) {
    const root = $('#viewer').content.cloneNode(true).firstElementChild;
    const data = article.dataset;
    const pictures = { actual: await pixels(data.actual) };
    const { width, height } = pictures.actual;
    for (const name of ['reference', ...QUESTIONS]) {
      if (data[name] !== undefined) pictures[name] = await pixels(data[name], [width, height]);
    }
    if (pictures.reference) pictures.difference = heatMap(pictures.reference, pictures.actual);
    // The user may have moved on in the meantime.
    if (open !== article) return;
    $('.viewer', article)?.remove();

    const canvas = $('canvas', root);
    Object.assign(canvas, { width, height });
    const context = canvas.getContext('2d');
    const slider = $('[type=range]', root);
    const [cross, edge] = [$('.cross', root), $('.edge', root)];
    const [xField, yField] = [$('[name=x]', root), $('[name=y]', root)];
    xField.max = (width - 1) * STEP;
    yField.max = (height - 1) * STEP;
    for (const field of [xField, yField]) field.step = STEP;
    let current = 'pictures';
    let [column, row] = [width >> 1, height >> 1];
    let exact = null;

    const paint = () => {
      context.putImageData(pictures[current] ?? pictures.actual, 0, 0);
      if (current === 'pictures' && pictures.reference) {
        context.putImageData(pictures.reference, 0, 0, 0, 0, Math.round((width * slider.value) / slider.max), height);
      }
      const percent = (100 * slider.value) / slider.max;
      edge.style.left = `${percent}%`;
      slider.ariaValueText = `${Math.round(percent)} % reference`;
      const legend = $('ul.legend', root);
      const entries = current === 'pictures' ? [] : legendOf(current);
      const used = entries.filter(([name]) => current !== 'difference' || name.startsWith('>'));
      legend.replaceChildren(...used.map(([name, colour]) => make('li', {}, swatch(colour), name)));
      $('.slide', root).hidden = current !== 'pictures' || !pictures.reference;
      edge.hidden = $('.slide', root).hidden;
    };

    const told = (name, at) => {
      const asked = $(`tr[data-question="${name}"] .number`, article) !== null;
      if (!asked) return ['not asked'];
      if (!pictures[name]) return ['no difference in any pixel'];
      const colour = colourOf(pictures[name], at);
      const entry = legendOf(name).find(([, own]) => own.every((part, index) => part === colour[index]));
      if (!entry) return ['no difference'];
      return [swatch(colour), entry[0].startsWith('>') ? `another by ${entry[0]}` : entry[0]];
    };
    const colourText = (colour) => [swatch(colour), `${colour.join(', ')} of 255`];
    const inspect = () => {
      const at = row * width + column;
      const [x, y] = [column * STEP, (height - 1 - row) * STEP];
      xField.value = x;
      yField.value = y;
      const actual = colourOf(pictures.actual, at);
      const lines = [];
      if (pictures.reference) {
        const reference = colourOf(pictures.reference, at);
        lines.push(['expected', colourText(reference)], ['actual', colourText(actual)]);
        lines.push(['difference', [`${differenceOf(reference, actual)} of 255 levels`]]);
      } else {
        lines.push(['actual', colourText(actual)]);
      }
      for (const name of QUESTIONS) lines.push([name, told(name, at)]);
      if (exact) lines.push([`${exact.question}: expected`, [exact.expected]], [`${exact.question}: actual`, [exact.actual]]);
      $('dl', root).replaceChildren(...lines.flatMap(([name, parts]) => [make('dt', { textContent: name }), make('dd', {}, ...parts)]));
      Object.assign(cross.style, {
        left: `${(100 * (column + 0.5)) / width}%`,
        top: `${(100 * (row + 0.5)) / height}%`,
        width: `${100 / width}%`,
        height: `${100 / height}%`,
      });
    };
    const choose = (toColumn, toRow, floats = null) => {
      column = Math.min(Math.max(toColumn, 0), width - 1);
      row = Math.min(Math.max(toRow, 0), height - 1);
      exact = floats;
      inspect();
    };

    const point = (event) => {
      if (event.buttons !== 1) return;
      const box = canvas.getBoundingClientRect();
      choose(
        Math.floor(((event.clientX - box.left) / box.width) * width),
        Math.floor(((event.clientY - box.top) / box.height) * height),
      );
    };
    canvas.addEventListener('pointerdown', point);
    canvas.addEventListener('pointermove', point);
    canvas.addEventListener('keydown', (event) => {
      const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      const step = steps[event.key];
      if (!step) return;
      event.preventDefault();
      const by = event.shiftKey ? 10 : 1;
      choose(column + by * step[0], row + by * step[1]);
    });
    const typed = () => choose(Math.floor(Number(xField.value) / STEP), height - 1 - Math.floor(Number(yField.value) / STEP));
    for (const field of [xField, yField]) field.addEventListener('change', typed);
    slider.addEventListener('input', paint);
    for (const radio of $$('[name=view]', root)) {
      const { value } = radio;
      radio.closest('label').hidden = value !== 'pictures' && !pictures[value];
      radio.checked = value === current;
      radio.addEventListener('change', () => {
        current = value;
        paint();
      });
    }
    // The pixels that the checks name become buttons, once.
    for (const span of $$('span.pixel', article)) {
      const button = make('button', { type: 'button', className: 'pixel', textContent: span.textContent });
      Object.assign(button.dataset, span.dataset);
      span.replaceWith(button);
    }
    const named = $$('button.pixel', article);
    const visit = ({ dataset, parentElement }) => {
      const question = parentElement.closest('tr').dataset.question;
      choose(Math.floor(dataset.x / STEP), height - 1 - Math.floor(dataset.y / STEP), {
        question,
        expected: dataset.expected,
        actual: dataset.actual,
      });
    };
    for (const button of named) button.onclick = () => visit(button);

    $('.pictures', article).append(root);
    paint();
    if (named.length > 0) visit(named[0]);
    else inspect();
  }

  filter();
  show();
})();
