// The behavior of the report's page where scripts run, besides the components that it shares with others.
(() => {
  'use strict';
  const { $, $$, make, button, addThemeButton, numberLines, copyButton, hideTip, isTipShown, openViewer, CHECKS, VALUES } = components;
  const settings = JSON.parse($('#settings').textContent);
  const STEP = settings.step;
  const own = document.currentScript;

  const main = $('main');
  const body = $('#shaders tbody');
  const rows = [...body.rows];
  const form = $('#filter');
  // The parts that scripts change, as they were, for the files of single shaders.
  const originals = new Map([form, $('#shaders thead')].map((element) => [element, element.cloneNode(true)]));
  const linkOf = (article) => $(`#shaders a[href="#${article.id}"]`);
  const rowOf = (article) => linkOf(article).closest('tr');
  const imageSource = (place) => `data:image/png;base64,${document.getElementById(`p${place}`).textContent}`;

  // The head: the date in local time, the theme, printing.

  for (const time of $$('time')) {
    const date = new Date(time.dateTime);
    time.title = time.textContent;
    time.textContent = date.toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });
  }
  addThemeButton($('.tools'));
  $('.tools').append(button('Print', () => print()));

  // The table: sorted by a click on a column header, filtered by text and verdicts.

  const heads = $$('#shaders thead [data-sort]');
  const words = new Intl.Collator(undefined, { numeric: true });

  const valueOf = (row, column) => {
    // The first cell is the thumbnail.
    const cell = row.cells[column + 1];
    return cell.dataset.by === undefined ? cell.textContent : Number(cell.dataset.by);
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
    const sorted = [...rows].sort((a, b) => (down ? -order(a, b) : order(a, b)));
    body.append(...sorted);
    updateMoves();
  };
  heads.forEach((head, column) => {
    const sorter = button(head.textContent, () => sort(column));
    if (head.dataset.term) sorter.setAttribute('aria-describedby', `${head.dataset.term}-text`);
    head.replaceChildren(sorter);
  });

  const filter = () => {
    const sought = form.words.value.trim().toLowerCase();
    const verdicts = new Set($$('[name=verdict]:checked', form).map((box) => box.value));
    let shown = 0;
    for (const row of rows) {
      const text = `${row.textContent} ${$('a', row).title}`.toLowerCase();
      row.hidden = !verdicts.has(row.dataset.verdict) || !text.includes(sought);
      shown += row.hidden ? 0 : 1;
    }
    $('#shown').textContent = `${shown} of ${rows.length} shown`;
    updateMoves();
  };
  form.addEventListener('input', filter);
  form.addEventListener('submit', (event) => event.preventDefault());
  form.hidden = false;

  // Thumbnails: a browser decodes those that are scrolled into view.

  const addThumbnail = (cell) => {
    if (cell.firstChild) return;
    if (cell.dataset.image === undefined) {
      cell.append(make('span', { className: 'empty', textContent: 'no image' }));
      return;
    }
    const link = $('a', cell.parentElement);
    const image = make('img', { alt: `actual image of ${link.textContent}`, src: imageSource(cell.dataset.image) });
    image.addEventListener('click', () => link.click());
    cell.append(image);
  };
  const thumbnails = rows.map((row) => $('.thumbnail', row));
  const visible = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (isIntersecting) {
        visible.unobserve(target);
        addThumbnail(target);
      }
    }
  });
  thumbnails.forEach((cell) => visible.observe(cell));

  // One shader.

  let open = null;
  const isSingle = rows.length === 1;
  const moves = {
    back: button('Back to all', () => close()),
    previous: button('Previous', () => go(-1)),
    next: button('Next', () => go(1)),
  };
  const bar = make(
    'nav',
    { className: 'moves', ariaLabel: 'Shaders' },
    ...Object.values(moves),
    make('span', { className: 'gap' }),
    button('Save as HTML', () => saveAlone(open), { title: 'Save the report on this shader as a file of its own' }),
    button('Print', () => print(), { title: 'Print the report on this shader' }),
  );

  const neighbor = (by) => {
    const shown = [...body.rows].filter((row) => !row.hidden);
    const at = shown.indexOf(rowOf(open));
    return at < 0 ? undefined : shown[at + by];
  };
  function updateMoves() {
    if (open) {
      moves.previous.disabled = !neighbor(-1);
      moves.next.disabled = !neighbor(1);
    }
  }
  const go = (by) => {
    const row = neighbor(by);
    if (row) location.hash = $('a', row).hash;
  };
  const close = () => {
    const link = linkOf(open);
    location.hash = '';
    // The table must be visible again before it can be focused.
    show();
    link.focus();
  };
  /** Moves the focus by rows of the table. */
  const focusRow = (link, by) => {
    const shown = [...body.rows].filter((row) => !row.hidden);
    const row = shown[shown.indexOf(link.closest('tr')) + by];
    if (row) $('a', row).focus();
  };
  document.addEventListener('keydown', (event) => {
    const { key, target } = event;
    if (event.defaultPrevented || event.altKey || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const vertical = { ArrowUp: -1, ArrowDown: 1 }[key];
    const horizontal = { ArrowLeft: -1, ArrowRight: 1 }[key];
    if (key === 'Escape' && isTipShown()) {
      hideTip();
    } else if (key === 'Escape' && open && !isSingle) {
      close();
    } else if (vertical && target.matches('#shaders tbody a')) {
      event.preventDefault();
      focusRow(target, vertical);
    } else if (horizontal && open && !target.closest('input, canvas, pre, .scroll, .source')) {
      go(horizontal);
    }
  });

  /** Prepares an article when it is shown first. */
  const prepare = (article) => {
    if (originals.has(article)) return;
    originals.set(article, article.cloneNode(true));
    numberLines(article);
    $$('.command', article).forEach(copyButton);
  };

  /** The entries of the glossary that articles refer to. */
  const entriesOf = (articles) =>
    new Set(articles.flatMap((article) => $$('[data-term]', article)).map(({ dataset }) => dataset.term));
  const showEntriesOf = (articles) => {
    const used = entriesOf(articles);
    for (const entry of $$('#glossary .entry')) entry.classList.toggle('unused', !used.has(entry.id));
  };
  const show = () => {
    const { hash } = location;
    const named = hash.length > 1 ? document.getElementById(hash.slice(1)) : null;
    const target = named?.matches('article') ? named : null;
    // An entry of the glossary is below the open shader.
    if (named?.matches('details')) named.open = true;
    if (named && !target && open) return;
    hideTip();
    if (open) {
      open.classList.remove('open');
      $('.viewer', open)?.dispatchEvent(new Event('close'));
      $('.viewer', open)?.remove();
      rowOf(open).classList.remove('open');
      linkOf(open).removeAttribute('aria-current');
    }
    open = target ?? (isSingle ? $('article') : null);
    main.classList.toggle('reading', open !== null);
    main.classList.toggle('single', isSingle);
    showEntriesOf(open ? [open] : $$('article'));
    if (!open) return;
    prepare(open);
    open.classList.add('open');
    if (!isSingle) open.prepend(bar);
    rowOf(open).classList.add('open');
    linkOf(open).setAttribute('aria-current', 'true');
    updateMoves();
    if (open.dataset.actual !== undefined) view(open);
    if (!target) return;
    $('h2', open).focus({ preventScroll: true });
    rowOf(open).scrollIntoView({ block: 'nearest' });
    scrollTo(0, 0);
  };
  addEventListener('hashchange', show);

  // The images of a shader.

  /** The pixels of an image's upper left part of the given size; of the whole image without a size. */
  const pixels = async (place, size) => {
    const image = new Image();
    image.src = imageSource(place);
    await image.decode();
    const [width, height] = size ?? [image.naturalWidth, image.naturalHeight];
    const canvas = make('canvas', { width, height });
    const context = canvas.getContext('2d', { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, width, height);
  };

  async function view(article) {
    const data = article.dataset;
    const images = { actual: await pixels(data.actual) };
    const { width, height } = images.actual;
    for (const name of ['reference', 'fixed', ...CHECKS, ...VALUES]) {
      if (data[name] !== undefined) images[name] = await pixels(data[name], [width, height]);
    }
    // The user may have moved on in the meantime.
    if (open !== article) return;
    $('.viewer', article)?.remove();
    const hasRun = (name) => $(`tr[data-check="${name}"] .number`, article) !== null;
    const viewer = openViewer({ name: data.name, settings, hasRun });
    viewer.root.addEventListener('close', viewer.close);
    viewer.setImages(images);
    // The pixels that the checks name become buttons, once.
    for (const span of $$('span.pixel', article)) {
      const named = button(span.textContent, null, { className: 'pixel' });
      Object.assign(named.dataset, span.dataset);
      span.replaceWith(named);
    }
    const named = $$('button.pixel', article);
    const visit = ({ dataset, parentElement }) => {
      viewer.choose(Math.floor(dataset.x / STEP), height - 1 - Math.floor(dataset.y / STEP), {
        check: parentElement.closest('tr').dataset.check,
        expected: dataset.expected,
        actual: dataset.actual,
      });
    };
    for (const pixel of named) pixel.onclick = () => visit(pixel);
    $('.images', article).append(viewer.root);
    if (named.length > 0) visit(named[0]);
  }

  // Paper: the shaders that the table shows, or the open one. The images are side by side.

  const figure = (article, name, caption) => {
    const image = make('img', { alt: `${caption} of ${article.dataset.name}`, src: imageSource(article.dataset[name]) });
    return make('figure', {}, image, make('figcaption', { textContent: caption }));
  };
  const CAPTIONS = {
    actual: 'Actual image',
    reference: 'Reference',
    fixed: 'Image after the fix',
    algorithm: 'Difference: algorithm check',
    precision: 'Difference: precision check',
    toolchain: 'Difference: toolchain check',
    value: 'First value that the reference does not have',
    referenceValue: 'Value of the reference that is missing',
  };
  let folded = [];
  addEventListener('beforeprint', () => {
    const printed = open ? [open] : $$('article').filter((article) => !rowOf(article).hidden);
    for (const article of $$('article')) article.classList.toggle('filtered', !printed.includes(article));
    for (const article of printed) {
      prepare(article);
      const names = Object.keys(CAPTIONS).filter((name) => article.dataset[name] !== undefined);
      const figures = names.map((name) => figure(article, name, CAPTIONS[name]));
      if (figures.length > 0) $('.images', article).append(make('div', { className: 'prints' }, ...figures));
    }
    folded = printed.flatMap((article) => $$('details:not([open])', article));
    showEntriesOf(printed);
    folded.push(...$$('#glossary details:not(.unused, [open])'));
    for (const details of folded) details.open = true;
    thumbnails.forEach(addThumbnail);
  });
  addEventListener('afterprint', () => {
    $$('.prints').forEach((prints) => prints.remove());
    for (const details of folded) details.open = false;
    showEntriesOf(open ? [open] : $$('article'));
  });

  // A page of one shader: this page without the other shaders.

  const alone = (article) => {
    const title = `toyproof check: ${article.dataset.name}`;
    const page = document.documentElement.cloneNode(false);
    page.removeAttribute('class');
    page.removeAttribute('data-theme');
    const head = document.head.cloneNode(true);
    $('title', head).textContent = title;

    const header = $('header.page').cloneNode(true);
    $('h1', header).textContent = title;
    $('.tools', header).replaceChildren();
    $$('.whole', header).forEach((fact) => fact.remove());

    const row = rowOf(article).cloneNode(true);
    row.removeAttribute('class');
    row.hidden = false;
    $('a', row).removeAttribute('aria-current');
    $('.thumbnail', row).replaceChildren();
    const ownForm = originals.get(form).cloneNode(true);
    for (const chip of $$('.chip', ownForm)) {
      if ($('input', chip).value === row.dataset.verdict) $('.count', chip).textContent = '1';
      else chip.remove();
    }
    const table = make('table', { id: 'shaders' });
    table.append($('#shaders caption').cloneNode(true), originals.get($('#shaders thead')).cloneNode(true), make('tbody', {}, row));
    const overview = $('#overview').cloneNode(false);
    overview.append(ownForm, table);
    const content = main.cloneNode(false);
    content.removeAttribute('class');
    content.append(overview, make('div', { id: 'articles' }, originals.get(article).cloneNode(true)));

    const glossary = $('#glossary').cloneNode(true);
    const used = entriesOf([article]);
    for (const entry of $$('.entry', glossary)) {
      entry.classList.remove('unused');
      if (!used.has(entry.id)) entry.remove();
    }
    const places = ['actual', 'reference', 'fixed', ...CHECKS, ...VALUES].map((name) => article.dataset[name]);
    const images = [...new Set(places)].filter(Boolean).map((place) => document.getElementById(`p${place}`).cloneNode(true));
    const rest = [$('#viewer'), ...images, $('#settings'), own].map((element) => element.cloneNode(true));
    page.append(head, make('body', {}, $('.skip').cloneNode(true), header, content, glossary, ...rest));
    return `<!DOCTYPE html>\n${page.outerHTML}\n`;
  };
  function saveAlone(article) {
    const name = article.dataset.name.replace(/\.\w+$/, '').replace(/[^\p{L}\p{N}._-]+/gu, '-');
    const address = URL.createObjectURL(new Blob([alone(article)], { type: 'text/html' }));
    make('a', { href: address, download: `toyproof-${name}.html` }).click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
  }

  filter();
  show();
})();
