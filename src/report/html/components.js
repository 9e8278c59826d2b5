// The parts that the report's page and the page of `toyproof watch` share: the theme, the tooltips of terms, listings,
// and the viewer of images. Shader texts are only ever inserted as text nodes.
const components = (() => {
  'use strict';
  const $ = (selector, within = document) => within.querySelector(selector);
  const $$ = (selector, within = document) => [...within.querySelectorAll(selector)];
  const make = (name, properties = {}, ...children) => {
    const element = Object.assign(document.createElement(name), properties);
    element.append(...children);
    return element;
  };
  const button = (text, onclick, properties = {}) => make('button', { type: 'button', textContent: text, onclick, ...properties });

  // The theme.

  const stored = (theme) => {
    // A browser may refuse storage to a page that is a file.
    try {
      if (theme) localStorage.setItem('toyproof-theme', theme);
      return localStorage.getItem('toyproof-theme');
    } catch {
      return null;
    }
  };
  const root = document.documentElement;
  const prefersDark = matchMedia('(prefers-color-scheme: dark)');
  const isDark = () => (root.dataset.theme ? root.dataset.theme === 'dark' : prefersDark.matches);
  const themeButton = button('Dark theme', () => setTheme(isDark() ? 'light' : 'dark'));
  const setTheme = (theme) => {
    if (theme === 'dark' || theme === 'light') root.dataset.theme = theme;
    themeButton.ariaPressed = String(isDark());
    stored(theme);
  };
  const addThemeButton = (tools) => {
    setTheme(stored());
    prefersDark.addEventListener('change', () => setTheme());
    tools.append(themeButton);
  };

  // Terms: a tooltip with the definition, on hover and on focus. It stays while the pointer is on it.

  const tip = make('div', { id: 'tip', role: 'tooltip', hidden: true });
  document.body.append(tip);
  const hideTip = () => {
    tip.hidden = true;
  };
  const showTip = (element) => {
    const definition = document.getElementById(`${element.dataset.term}-text`);
    if (!definition) return;
    tip.textContent = definition.textContent;
    tip.hidden = false;
    const [at, size] = [element.getBoundingClientRect(), tip.getBoundingClientRect()];
    const below = at.bottom + size.height < innerHeight || at.top < size.height;
    tip.style.left = `${Math.max(8, Math.min(at.left, innerWidth - size.width - 8))}px`;
    tip.style.top = `${below ? at.bottom : at.top - size.height}px`;
  };
  document.addEventListener('pointerover', ({ target, pointerType }) => {
    const term = target.closest('[data-term]');
    if (term && pointerType !== 'touch') showTip(term);
    else if (!tip.contains(target)) hideTip();
  });
  document.addEventListener('focusin', ({ target }) => {
    const term = target.closest('[data-term]');
    if (term && target.matches(':focus-visible')) showTip(term);
    else hideTip();
  });
  const moveTip = () => {
    // Focus may scroll the page to the term, whose definition then moves along.
    const focused = document.activeElement?.closest('[data-term]');
    if (!tip.hidden && focused?.matches(':focus-visible')) showTip(focused);
    else hideTip();
  };
  document.addEventListener('scroll', moveTip, { capture: true, passive: true });
  const isTipShown = () => !tip.hidden;

  // Listings and commands.

  /** Numbers the lines of the source. */
  const numberLines = (article) => {
    for (const block of $$('pre[data-first]', article)) {
      const first = Number(block.dataset.first);
      const lines = block.textContent.split('\n');
      const spans = lines.map((text, index) => {
        const line = make('span', { className: 'line', textContent: text });
        line.dataset.line = first + index;
        return line;
      });
      block.firstElementChild.replaceChildren(...spans);
      delete block.dataset.first;
    }
  };
  const copy = async (text, done) => {
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      const field = make('textarea', { value: text });
      document.body.append(field);
      field.select();
      document.execCommand('copy');
      field.remove();
    }
    done();
  };
  /** Adds a button that copies a command. */
  const copyButton = (command) => {
    const status = make('span', { role: 'status' });
    const copier = button('Copy', () =>
      copy($('code', command).textContent, () => {
        status.textContent = 'copied';
        setTimeout(() => status.replaceChildren(), 2000);
        copier.focus();
      }),
    );
    copier.ariaLabel = 'Copy the command';
    command.append(copier, status);
  };

  // The viewer.

  const CHECKS = ['algorithm', 'precision', 'toolchain'];
  const VALUES = ['value', 'referenceValue'];
  const HEAT_MAPS = ['difference', ...CHECKS];
  const BLINK_MS = 800;
  const colorOf = (image, at) => [...image.data.subarray(4 * at, 4 * at + 3)];
  const differenceOf = (a, b) => Math.max(...a.map((value, part) => Math.abs(value - b[part])));
  const isBand = ([name]) => name.startsWith('>');
  const swatch = (color) => {
    const box = make('span', { className: 'swatch', ariaHidden: 'true' });
    box.style.backgroundColor = `rgb(${color})`;
    return box;
  };

  /**
   * Opens a viewer of images of the same size: the actual one, and perhaps the reference, the image after the fix, the
   * maps of the checks and values. `hasRun` returns whether a check ran; without it, checks are not listed. `onPoint`
   * returns whether it uses an event of the pointer; `onChoose` gets the pixel that is inspected, from the left and from
   * the bottom. With `hovers`, the pixel under the pointer is inspected.
   */
  const openViewer = ({ name, settings, hasRun, onPoint = () => false, onChoose = () => {}, hovers = () => false }) => {
    const { step } = settings;
    const root = $('#viewer').content.cloneNode(true).firstElementChild;
    const canvas = $('canvas', root);
    canvas.ariaLabel = `Image of ${name}; the arrow keys select a pixel`;
    const context = canvas.getContext('2d');
    const slider = $('[type=range]', root);
    const [cross, edge] = [$('.cross', root), $('.edge', root)];
    const [xField, yField] = [$('[name=x]', root), $('[name=y]', root)];
    const radios = $$('[name=view]', root);
    // A page may show the inspector elsewhere.
    const inspector = $('.inspector', root);
    const values = $('dl', inspector);
    const [referenceLabel] = $$('.slide span', root);
    /** The legend's colors for magnitudes, the largest first. */
    const bands = settings.eye.filter(isBand).reverse();
    /** The color of a difference in 8-bit levels. */
    const heat = Array.from({ length: 256 }, (_, levels) => {
      const band = bands.find(([label]) => levels / 255 > Number(label.slice(2)));
      return [...(band ? band[1] : [0, 0, 0]), 255];
    });
    const heatMap = (reference, actual) => {
      const [map, a, b] = [new ImageData(actual.width, actual.height), reference.data, actual.data];
      for (let at = 0; at < a.length; at += 4) {
        const red = Math.abs(a[at] - b[at]);
        const green = Math.abs(a[at + 1] - b[at + 1]);
        map.data.set(heat[Math.max(red, green, Math.abs(a[at + 2] - b[at + 2]))], at);
      }
      return map;
    };
    const legendOf = (view) => (view === 'toolchain' ? settings.bits : settings.eye);
    let images = {};
    let [width, height] = [0, 0];
    let current = 'slider';
    let blinking = 0;
    let [column, row] = [0, 0];
    let exact = null;
    let reference = 'Reference';

    const has = (view) => {
      if (view === 'slider') return images.actual !== undefined;
      if (view === 'blink' || view === 'difference') return images.reference !== undefined;
      return images[view] !== undefined;
    };
    const imageOf = (view) => {
      if (view === 'slider' || view === 'blink') return images.actual;
      if (view === 'difference') images.difference ??= heatMap(images.reference, images.actual);
      return images[view];
    };
    const render = () => {
      context.putImageData(imageOf(current), 0, 0);
      if (current !== 'blink') $('.shown', root).textContent = '';
      if (current === 'slider' && images.reference) {
        context.putImageData(images.reference, 0, 0, 0, 0, Math.round((width * slider.value) / slider.max), height);
      }
      const percent = (100 * slider.value) / slider.max;
      edge.style.left = `${percent}%`;
      slider.ariaValueText = `${Math.round(percent)} % ${reference.toLowerCase()}`;
      const legend = $('ul.legend', root);
      const entries = HEAT_MAPS.includes(current) ? legendOf(current) : [];
      const used = entries.filter((entry) => current !== 'difference' || isBand(entry));
      legend.replaceChildren(...used.map(([label, color]) => make('li', {}, swatch(color), label)));
      $('.slide', root).hidden = current !== 'slider' || !images.reference;
      edge.hidden = $('.slide', root).hidden;
    };
    const blink = () => {
      const isReference = $('.shown', root).textContent !== reference.toLowerCase();
      context.putImageData(isReference ? images.reference : images.actual, 0, 0);
      $('.shown', root).textContent = isReference ? reference.toLowerCase() : 'actual';
    };
    const select = (view) => {
      clearInterval(blinking);
      current = view;
      for (const radio of radios) radio.checked = radio.value === view;
      render();
      if (current === 'blink') {
        blink();
        blinking = setInterval(blink, BLINK_MS);
      }
    };
    const close = () => clearInterval(blinking);

    const describe = (check, at) => {
      if (!hasRun(check)) return ['not run'];
      if (!images[check]) return ['within the tolerance in every pixel'];
      const color = colorOf(images[check], at);
      const entry = legendOf(check).find(([, own]) => own.every((part, index) => part === color[index]));
      if (!entry) return ['equal'];
      return [swatch(color), isBand(entry) ? `differs by ${entry[0]}` : entry[0]];
    };
    const colorText = (color) => [swatch(color), `${color.join(', ')} of 255`];
    const inspect = () => {
      const at = row * width + column;
      const [x, y] = [column * step, (height - 1 - row) * step];
      xField.value = x;
      yField.value = y;
      const actual = colorOf(images.actual, at);
      const lines = [];
      if (images.reference) {
        const expected = colorOf(images.reference, at);
        const levels = differenceOf(expected, actual);
        lines.push([reference === 'Reference' ? 'expected' : reference, colorText(expected)], ['actual', colorText(actual)]);
        lines.push(['difference', [`${levels} of 255 levels`]]);
      } else {
        lines.push(['actual', colorText(actual)]);
      }
      if (images.fixed) lines.push(['after the fix', colorText(colorOf(images.fixed, at))]);
      if (hasRun) for (const check of CHECKS) lines.push([`${check} check`, describe(check, at)]);
      if (exact) {
        lines.push([`${exact.check}: expected`, [exact.expected]], [`${exact.check}: actual`, [exact.actual]]);
      }
      values.replaceChildren(
        ...lines.flatMap(([term, parts]) => [make('dt', { textContent: term }), make('dd', {}, ...parts)]),
      );
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
      onChoose([column * step, (height - 1 - row) * step]);
    };

    /** The pixel of an event of the pointer, from the left and from the top; it may be outside. */
    const placeOf = (event) => {
      const box = canvas.getBoundingClientRect();
      return [((event.clientX - box.left) / box.width) * width, ((event.clientY - box.top) / box.height) * height];
    };
    const point = (event) => {
      if (!images.actual || onPoint(event, placeOf(event))) return;
      if (event.buttons === 1 || (event.buttons === 0 && event.type === 'pointermove' && hovers())) {
        choose(...placeOf(event).map(Math.floor));
      }
    };
    for (const type of ['pointerdown', 'pointermove', 'pointerup']) canvas.addEventListener(type, point);
    canvas.addEventListener('keydown', (event) => {
      const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
      const by = steps[event.key];
      if (!by || !images.actual || event.defaultPrevented) return;
      event.preventDefault();
      const length = event.shiftKey ? 10 : 1;
      choose(column + length * by[0], row + length * by[1]);
    });
    const typed = () => choose(Math.floor(Number(xField.value) / step), height - 1 - Math.floor(Number(yField.value) / step));
    for (const field of [xField, yField]) field.addEventListener('change', typed);
    slider.addEventListener('input', render);
    for (const radio of radios) radio.addEventListener('change', () => select(radio.value));

    /** Shows other images. They may have another size than the last ones. */
    const setImages = (shown, referenceName = 'Reference') => {
      images = { ...shown };
      reference = referenceName;
      referenceLabel.textContent = reference;
      const size = images.actual;
      const isResized = size.width !== width || size.height !== height;
      if (isResized) {
        [width, height] = [size.width, size.height];
        Object.assign(canvas, { width, height });
        [column, row] = [width >> 1, height >> 1];
        xField.max = (width - 1) * step;
        yField.max = (height - 1) * step;
        for (const field of [xField, yField]) field.step = step;
        onChoose([column * step, (height - 1 - row) * step]);
      }
      for (const radio of radios) radio.closest('label').hidden = !has(radio.value);
      if (!has(current)) select('slider');
      else if (current !== 'blink') render();
      inspect();
    };
    for (const radio of radios) radio.checked = radio.value === current;
    return { root, canvas, inspector, setImages, choose, close };
  };

  return {
    $,
    $$,
    make,
    button,
    addThemeButton,
    numberLines,
    copyButton,
    hideTip,
    isTipShown,
    openViewer,
    CHECKS,
    VALUES,
  };
})();
