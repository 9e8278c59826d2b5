// The page of `toyproof watch`: follows the events of the server, and requests the images of this tab's moment. Time,
// size, mouse, keyboard and uniforms are this tab's own.
(() => {
  'use strict';
  const { $, $$, make, addThemeButton, numberLines, copyButton, openViewer } = components;
  const RATE = 60;
  const MAX_FRAME = 2 ** 30;
  /** The frames that the server and WebGL 2 render for one that is shown. */
  const MAX_REPLAYED = 300;
  const PIXEL_DELAY_MS = 80;

  const by = (id) => document.getElementById(id);
  const images = by('images');
  const controls = { time: by('time'), frame: by('frame'), speed: by('speed'), play: by('play') };
  addThemeButton($('.tools'));

  // The state of this tab.

  let tab = 0;
  /** The last version of the shader, as the server described it. */
  let version = null;
  /** The check of the last version. */
  let check = null;
  let viewer = null;
  const moment = { frame: 0, start: 0 };
  let isPlaying = false;
  const mouse = [0, 0, -0, -0];
  const keys = { held: new Set(), pressed: new Set(), toggled: new Set() };
  const uniforms = new Map();
  let isStarted = false;

  const sizeNow = () => {
    const fixed = version.reference?.size;
    const [width, height] = by('size').value ? by('size').value.split('x').map(Number) : (fixed ?? version.frame.size);
    return [width, height];
  };
  const view = () => ({
    tab,
    size: sizeNow(),
    time: moment.start + moment.frame / RATE,
    frame: moment.frame,
    mouse: [...mouse],
    keys: Object.fromEntries(Object.entries(keys).map(([name, codes]) => [name, [...codes]])),
    uniforms: [...uniforms].map(([name, components]) => ({ name, components })),
    pass: by('pass').value || 'image',
  });

  // Requests. Each kind has one at a time: the server stops an earlier one.

  const post = (path, body) => fetch(path, { method: 'POST', body: JSON.stringify(body) });
  /** The answer as JSON or pixels; throws a message, or null if the shader has changed in the meantime. */
  const checkAnswer = async (answer) => {
    if (answer.status === 409) throw null;
    if (answer.status === 422) throw (await answer.json()).message;
    if (!answer.ok) throw `the server answers ${answer.status}`;
    return answer;
  };
  const readPixels = async (answer) => {
    const bytes = new Uint8Array(await (await checkAnswer(answer)).arrayBuffer());
    const end = bytes.indexOf(10);
    const head = JSON.parse(new TextDecoder().decode(bytes.subarray(0, end)));
    if (!head) return null;
    const [width, height] = head.size;
    return { head, image: new ImageData(new Uint8ClampedArray(bytes.buffer, end + 1, 4 * width * height), width, height) };
  };

  let isRendering = false;
  let isWanted = false;
  /** The reference that was shown last, and what it depends on. */
  let reference = { key: '', image: null };

  const referenceFor = async (shown) => {
    if (!version.reference || shown.pass !== 'image') return null;
    const { size, time, frame, mouse: at } = shown;
    const key = JSON.stringify([version.version, size, version.reference.isAnimated ? [time, frame, at] : null]);
    if (reference.key !== key) {
      const answer = await readPixels(await post('reference', shown));
      reference = { key, image: answer?.image ?? null };
    }
    return reference.image;
  };

  /** Whether the check was of this view. */
  const isChecked = (shown) => {
    const { size, time, frame, mouse: at } = version.frame;
    const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
    const isSame = same([shown.size, Math.fround(shown.time), shown.frame, shown.mouse], [size, Math.fround(time), frame, at]);
    return isSame && shown.pass === 'image' && shown.uniforms.length === 0;
  };

  const problem = (message) => {
    by('problem').hidden = !message;
    by('problem').textContent = message ?? '';
  };
  const renderOnce = async () => {
    const shown = view();
    keys.pressed.clear();
    const started = performance.now();
    const { head, image } = await readPixels(await post('frame', shown));
    const seconds = (performance.now() - started) / 1000;
    const all = { actual: image };
    let referenceName = 'Reference';
    const show = () => {
      if (!viewer) {
        viewer = openViewer({
          name: version.name,
          settings: version.settings,
          hasRun: (name) => check?.ran?.[name] ?? false,
          onPoint,
          onChoose,
          hovers: () => !isPlaying && !isPinned,
        });
        images.replaceChildren(viewer.root);
        by('inspected').replaceChildren(viewer.inspector);
        // Before the viewer's own keys.
        viewer.canvas.addEventListener('keydown', onKey, { capture: true });
      }
      viewer.setImages(all, referenceName);
      images.classList.toggle('stale', version.compiles === false);
      images.dataset.version = head.version;
      images.dataset.frame = shown.frame;
    };
    // The image does not wait for what it is compared with.
    const isNew = Number(images.dataset.version) !== head.version;
    if (isNew && reference.image && reference.image.width === image.width && reference.image.height === image.height) {
      all.reference = reference.image;
    }
    if (isNew || !isPlaying) show();
    const notes = [];
    try {
      if (by('comparison').value === 'browser') {
        all.reference = await renderInBrowser(shown, head);
        referenceName = 'WebGL 2';
      } else {
        all.reference = (await referenceFor(shown)) ?? undefined;
      }
    } catch (message) {
      if (message === null) throw null;
      delete all.reference;
      notes.push(by('comparison').value === 'browser' ? `WebGL 2: ${message}` : `The reference: ${message}`);
    }
    if (check?.decoded && isChecked(shown)) Object.assign(all, check.decoded);
    show();
    if (head.firstFrame > 0 && version.hasHistory) notes.push(`The buffers start with zeros in frame ${head.firstFrame}.`);
    if (version.reference?.size && String(shown.size) !== String(version.reference.size)) {
      notes.push('The reference is an image of another size.');
    }
    by('note').textContent = notes.join(' ');
    by('rendered').textContent = `${shown.size.join('×')}, ${(1000 * seconds).toFixed(0)} ms`;
    problem(standingProblem());
  };
  /** What is wrong with the last version, although there is an image. */
  const standingProblem = () => {
    if (version.compiles) return version.referenceFailure;
    return viewer && 'The image is that of the last version that compiles.';
  };
  /** Renders what this tab shows, again until it is what it shows now. */
  const render = async () => {
    isWanted = true;
    if (isRendering || !version?.version) return;
    isRendering = true;
    while (isWanted) {
      isWanted = false;
      try {
        await renderOnce();
      } catch (message) {
        if (message !== null) {
          problem(message instanceof TypeError ? 'The server does not answer.' : `${message.message ?? message}`);
          images.classList.toggle('stale', viewer !== null);
          setPlaying(false);
        }
      }
      if (isPlaying) {
        await new Promise(requestAnimationFrame);
        if (isPlaying) advance();
      }
    }
    isRendering = false;
    inspectPixel();
  };

  // WebGL 2 of this browser: the same frames, by the player of `toyproof convert --browser`.

  let player = null;
  let playerScript = null;
  /** Loads the player, which opens a WebGL context, with its first use. */
  const loadPlayer = () =>
    (playerScript ??= new Promise((done, fail) => {
      const onerror = () => fail('the server does not answer');
      document.body.append(make('script', { src: 'browser.js', onload: done, onerror }));
    }));

  const blockAt = (bytes, inputs, number) => {
    const block = new Uint8Array(bytes);
    const word = (name) => inputs.find((input) => input.name === name).word;
    new Float32Array(block.buffer)[word('iTime')] = moment.start + number / RATE;
    new Int32Array(block.buffer)[word('iFrame')] = number;
    return block;
  };
  const keyTexels = () => {
    const texels = new Float32Array(4 * 256 * 3);
    [keys.held, keys.pressed, keys.toggled].forEach((codes, row) => {
      for (const code of codes) texels[4 * (256 * row + code)] = 1;
    });
    for (let at = 3; at < texels.length; at += 4) texels[at] = 1;
    return texels;
  };
  const renderInBrowser = async (shown, { version: number, size, block }) => {
    await loadPlayer();
    const key = JSON.stringify([number, size, shown.pass, shown.uniforms]);
    if (player?.key !== key) {
      player?.opened.close();
      player = null;
      const { job } = await (await checkAnswer(await post('browser', shown))).json();
      decodeTextures(job.textures);
      player = { key, job, opened: openPasses(job.passes, job.inputs, job.textures), last: null };
    }
    const { job, opened, last } = player;
    const [width, height] = size;
    const isNext = last !== null && last < shown.frame && shown.frame - last <= MAX_REPLAYED;
    const single = job.passes.length === 1;
    let frame = single ? shown.frame : isNext ? last + 1 : Math.max(0, shown.frame - MAX_REPLAYED);
    const target = shown.pass === 'image' ? 'image' : `buffer${shown.pass.charCodeAt(shown.pass.length - 1) - 97}`;
    let restarts = single || !isNext;
    let pixels;
    for (; frame <= shown.frame; frame++) {
      const own = blockAt(block, job.inputs, frame);
      pixels = opened.render({ width, height, block: own, restarts, keys: keyTexels(), shown: target });
      restarts = false;
    }
    player.last = shown.frame;
    const image = new ImageData(width, height);
    for (let row = 0; row < height; row++) {
      const from = 4 * width * (height - 1 - row);
      for (let at = 0; at < 4 * width; at++) image.data[4 * width * row + at] = 255 * pixels[from + at];
      for (let at = 3; at < 4 * width; at += 4) image.data[4 * width * row + at] = 255;
    }
    return image;
  };

  // Time.

  let last = 0;
  let rest = 0;
  const showMoment = () => {
    if (document.activeElement !== controls.time) controls.time.value = (moment.start + moment.frame / RATE).toFixed(3);
    if (document.activeElement !== controls.frame) controls.frame.value = moment.frame;
  };
  const setFrame = (frame) => {
    moment.frame = Math.min(Math.max(Math.round(frame), 0), MAX_FRAME);
    showMoment();
    render();
  };
  /** Goes on by the time that has passed. A frame that depends on the one before it follows that one. */
  const advance = () => {
    const now = performance.now();
    rest += ((now - last) / 1000) * RATE * Number(controls.speed.value);
    last = now;
    let frames = Math.floor(rest);
    if (version.hasHistory) frames = Math.min(frames, 1);
    rest = version.hasHistory ? Math.min(rest - frames, 1) : rest - frames;
    moment.frame = Math.min(moment.frame + frames, MAX_FRAME);
    showMoment();
    isWanted = true;
  };
  const setPlaying = (plays) => {
    isPlaying = plays;
    controls.play.textContent = plays ? 'Pause' : 'Play';
    controls.play.ariaPressed = String(plays);
    if (plays) {
      [last, rest] = [performance.now(), 0];
      viewer?.canvas.focus({ preventScroll: true });
      render();
    } else {
      keys.held.clear();
    }
  };
  controls.play.addEventListener('click', () => setPlaying(!isPlaying));
  by('step').addEventListener('click', () => (setPlaying(false), setFrame(moment.frame + 1)));
  by('step-back').addEventListener('click', () => (setPlaying(false), setFrame(moment.frame - 1)));
  const reset = () => {
    moment.start = 0;
    mouse.splice(0, 4, 0, 0, -0, -0);
    for (const codes of Object.values(keys)) codes.clear();
    setFrame(0);
  };
  by('reset').addEventListener('click', reset);
  controls.time.addEventListener('change', () => {
    moment.start = 0;
    setFrame(Number(controls.time.value) * RATE);
  });
  controls.frame.addEventListener('change', () => setFrame(Number(controls.frame.value)));
  for (const id of ['size', 'pass', 'comparison']) by(id).addEventListener('change', () => render());

  // The mouse and the keyboard: the shader's while it plays, else those of the pixel that is inspected.

  let isPinned = false;
  const onPoint = (event, [x, fromTop]) => {
    if (!isPlaying) {
      if (event.type === 'pointerdown') isPinned = !isPinned;
      return false;
    }
    const { width, height } = viewer.canvas;
    const at = [Math.min(Math.max(Math.floor(x), 0), width - 1) + 0.5, height - 0.5 - Math.min(Math.max(Math.floor(fromTop), 0), height - 1)];
    if (event.type === 'pointerdown') {
      viewer.canvas.setPointerCapture(event.pointerId);
      mouse.splice(0, 4, ...at, ...at);
    } else if (event.type === 'pointermove' && event.buttons & 1) {
      // As on the site, w is positive in the frame of the click only.
      mouse.splice(0, 2, ...at);
      mouse[3] = -Math.abs(mouse[3]);
    } else if (event.type === 'pointerup') {
      mouse[2] = -Math.abs(mouse[2]);
      mouse[3] = -Math.abs(mouse[3]);
    }
    return true;
  };
  /** The keys of the image: those of the time, and while it plays all others for the shader. */
  const onKey = (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.key === 'Tab' || event.key === 'Escape') return;
    if (!isPlaying) return;
    const code = event.keyCode;
    if (code > 255) return;
    event.preventDefault();
    if (event.repeat) return;
    keys.held.add(code);
    keys.pressed.add(code);
    if (!keys.toggled.delete(code)) keys.toggled.add(code);
  };
  document.addEventListener('keyup', ({ keyCode }) => keys.held.delete(keyCode));
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.target.closest('input, select, textarea, summary, pre')) return;
    const action = {
      Escape: () => isPlaying && setPlaying(false),
      '.': () => setFrame(moment.frame + 1),
      ',': () => setFrame(moment.frame - 1),
      Home: reset,
      p: () => setPlaying(!isPlaying),
    }[event.key];
    if (action && version) {
      event.preventDefault();
      action();
    }
  });

  // The values in a pixel.

  let pixel = null;
  let pixelTimer = 0;
  let isTracing = false;
  let traced = '';
  const tracePixel = async () => {
    const wanted = { view: view(), pixel };
    // The page asks for one pixel after the other, and for the last one only.
    if (isTracing || traced === JSON.stringify([wanted, version.version])) return;
    isTracing = true;
    traced = JSON.stringify([wanted, version.version]);
    try {
      const answer = await checkAnswer(await post('pixel', wanted));
      $('#values pre').textContent = (await answer.json()).text;
    } catch (message) {
      if (message === null) {
        // The next version requests it again.
        [isTracing, traced] = [false, ''];
        return;
      }
      $('#values pre').textContent = `${message.message ?? message}`;
    }
    isTracing = false;
    inspectPixel();
  };
  const inspectPixel = () => {
    clearTimeout(pixelTimer);
    if (!pixel || isPlaying || !version?.version || !by('values').open) return;
    pixelTimer = setTimeout(tracePixel, PIXEL_DELAY_MS);
  };
  const onChoose = (chosen) => {
    pixel = chosen;
    inspectPixel();
  };
  by('values').addEventListener('toggle', inspectPixel);

  // Uniforms.

  const slider = ({ name, kind, components }) => {
    const values = [...(uniforms.get(name) ?? components)];
    const rows = values.flatMap((value, at) => {
      const label = components.length === 1 ? name : `${name}.${'xyzw'[at]}`;
      const set = (to) => {
        values[at] = to;
        uniforms.set(name, [...values]);
        render();
      };
      if (kind === 'bool') {
        const box = make('input', { type: 'checkbox', checked: value !== 0, ariaLabel: label });
        box.addEventListener('change', () => set(box.checked ? 1 : 0));
        return [make('span', { textContent: label }), box, make('span')];
      }
      const reach = Math.max(1, 2 * Math.abs(components[at]));
      const step = kind === 'int' ? 1 : 'any';
      const range = make('input', { type: 'range', min: components[at] < 0 ? -reach : 0, max: reach, step, value, ariaLabel: label });
      const number = make('input', { type: 'number', step, value, ariaLabel: `${label}, as a number` });
      range.addEventListener('input', () => {
        number.value = kind === 'int' ? range.value : Number(range.value).toPrecision(4);
        set(Number(range.value));
      });
      number.addEventListener('change', () => {
        if (number.value === '') return;
        range.value = number.value;
        set(Number(number.value));
      });
      return [make('span', { textContent: label }), range, number];
    });
    return make('div', { className: 'uniform' }, ...rows);
  };
  let shownUniforms = '';
  const showUniforms = () => {
    const described = JSON.stringify(version.uniforms);
    // The sliders stay as they are while the text changes elsewhere.
    if (described === shownUniforms) return;
    shownUniforms = described;
    const names = new Set(version.uniforms.map(({ name }) => name));
    for (const name of [...uniforms.keys()]) if (!names.has(name)) uniforms.delete(name);
    const box = by('uniforms');
    box.replaceChildren($('legend', box), ...version.uniforms.map(slider));
    box.hidden = version.uniforms.length === 0;
  };

  // The findings.

  const state = (verdict, text, rest = '') =>
    by('state').replaceChildren(make('span', { className: `verdict ${verdict}`, textContent: text }), rest && ` ${rest}`);
  /** Shows an article that the server has formatted: no text of a shader in it is markup. */
  const showArticle = (article) => {
    by('article').innerHTML = article.html;
    by('explanations').innerHTML = article.glossary;
    numberLines(by('article'));
    $$('.command', by('article')).forEach(copyButton);
    const used = new Set($$('[data-term]', by('article')).map(({ dataset }) => dataset.term));
    for (const entry of $$('#glossary .entry')) entry.classList.toggle('unused', !used.has(entry.id));
    for (const span of $$('span.pixel', by('article'))) {
      const { dataset, textContent } = span;
      const named = make('button', { type: 'button', className: 'pixel', textContent });
      named.addEventListener('click', () => choosePixel(dataset));
      span.replaceWith(named);
    }
  };
  const choosePixel = ({ x, y }) => {
    if (!viewer) return;
    setPlaying(false);
    isPinned = true;
    viewer.choose(Number(x), viewer.canvas.height - 1 - Number(y));
  };
  addEventListener('hashchange', () => {
    const entry = location.hash.length > 1 && document.getElementById(location.hash.slice(1));
    if (entry?.matches?.('details')) entry.open = true;
  });
  const decode = async (urls) => {
    const decoded = await Promise.all(
      Object.entries(urls).map(async ([name, url]) => {
        const image = new Image();
        image.src = url;
        await image.decode();
        const [width, height] = version.frame.size;
        const context = make('canvas', { width, height }).getContext('2d', { willReadFrequently: true });
        context.drawImage(image, 0, 0);
        return [name, context.getImageData(0, 0, width, height)];
      }),
    );
    return Object.fromEntries(decoded);
  };

  const start = () => {
    const { frame } = version;
    if (isStarted || !frame) return;
    isStarted = true;
    moment.frame = frame.frame;
    moment.start = frame.time - frame.frame / RATE;
    mouse.splice(0, 4, ...frame.mouse);
    showMoment();
  };
  const onVersion = (described) => {
    // What does not compile has no passes and no uniforms; those of the last version that does stay.
    version = described.compiles ? described : { ...version, ...described, ...(version?.frame && keep(version)) };
    check = null;
    by('name').textContent = described.name;
    document.title = `${described.name} – toyproof watch`;
    const facts = [
      ['reference-name', described.reference && `Reference: ${described.reference.name}`],
      ['dialect', described.dialect],
    ];
    for (const [id, text] of facts) {
      by(id).hidden = !text;
      by(id).textContent = text ?? '';
    }
    by('findings').classList.toggle('stale', described.compiles);
    if (described.compiles) {
      state('ok', 'checking', described.warnings ?? '');
      const names = version.passes;
      const chosen = by('pass').value;
      by('pass').replaceChildren(...names.map((name) => make('option', { value: name, textContent: name })));
      by('pass').value = names.includes(chosen) ? chosen : 'image';
      by('passes').hidden = names.length === 1;
      start();
      showUniforms();
    } else if (described.article) {
      showArticle(described.article);
      by('state').replaceChildren();
    } else {
      state('invalid', 'error', described.failure);
    }
    problem(standingProblem());
    images.classList.toggle('stale', !described.compiles);
    render();
  };
  const keep = ({ frame, passes, uniforms: declared, hasHistory, reference: compared }) => ({
    frame,
    passes,
    uniforms: declared,
    hasHistory,
    reference: compared,
  });
  const onCheck = async (result) => {
    check = result;
    by('findings').classList.remove('stale');
    if (result.failure) {
      state('error', 'error', result.failure);
      return;
    }
    by('state').replaceChildren();
    showArticle(result.article);
    result.decoded = await decode(result.images);
    if (check === result && !isPlaying) render();
  };

  // The events. A connection that ends is opened again by the browser.

  const events = new EventSource('events');
  events.addEventListener('tab', ({ data }) => {
    tab = Number(data);
  });
  events.addEventListener('version', ({ data }) => onVersion(JSON.parse(data)));
  events.addEventListener('check', ({ data }) => onCheck(JSON.parse(data)));
  events.addEventListener('error', () => problem('The connection is lost: `toyproof watch` has ended, or is busy.'));
  events.addEventListener('open', () => problem(version && standingProblem()));
})();
