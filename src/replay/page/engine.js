// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The engine of a live page: bbsim itself as WebAssembly, in a worker without network. wasm/engine.cpp
// describes requests and answers.
bbsim.makeEngine = () => {
  const textOf = (id) => document.getElementById(id).textContent;

  // The worker's own code, after the script that loads the module.
  // `lines`: of the viewer's controller, which comes before it.
  function work(lines) {
    const begin = async (packed) => {
      // Base 85: five characters are four bytes (wasm/bundle.py).
      const signs = '0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz!#$%/()*+-;,=.?@^_`{|}~';
      const digits = new Uint8Array(128), bytes = new Uint8Array(Math.floor(packed.length * 4 / 5)), view = new DataView(new ArrayBuffer(4));
      for (let i = 0; i < 85; ++i) digits[signs.charCodeAt(i)] = i;
      for (let from = 0, to = 0; from < packed.length; from += 5, to += 4) {
        let number = 0;
        for (let i = from; i < from + 5; ++i) number = number * 85 + (i < packed.length ? digits[packed.charCodeAt(i)] : 84);
        view.setUint32(0, number);
        for (let i = 0; i < 4; ++i) bytes[to + i] = view.getUint8(i);
      }
      const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
      return bbsimEngine({wasmBinary: await new Response(unpacked).arrayBuffer()});
    };
    // A fault of the viewer's controller, at its line.
    function faultOf(error) {
      const at = /blob:[^)\s]*?:(\d+):\d+/.exec(error && error.stack || ''), line = at ? Number(at[1]) : Infinity;
      return `the controller of this page${line <= lines ? `, line ${line}` : ''}: ${error && error.message || error}`;
    }
    const shown = (value) => (Array.isArray(value) ? `[${value.map(shown).join(', ')}]` : typeof value === 'object' ? JSON.stringify(value) : String(value));
    // Calls step(sample) of the viewer's controller for wasm/engine.cpp, whose numbers these are.
    function command(its, n, commands) {
      try {
        if (n[0] === 0 && typeof reset === 'function') reset();
        const pair = (i) => [n[i], n[i + 1]];
        const given = step({sample: n[0], t: n[1], ball: n[2] ? pair(3) : null, reference: pair(5), reference_rate: pair(7),
                            reference_acceleration: pair(9), servo: pair(11), servo_rate: pair(13), period: n[15]});
        const pairOf = Array.isArray(given) ? given : given && given.command;
        if (!Array.isArray(pairOf) || pairOf.length !== 2 || !pairOf.every(Number.isFinite)) {
          throw new Error(`step() returned ${shown(given)}; allowed: [phi, theta], two finite numbers`);
        }
        commands.set(pairOf);
        return 0;
      } catch (error) {
        its.fault = faultOf(error);
        return 1;
      }
    }
    let engine = null;
    onmessage = async ({data: {packed, id, request}}) => {
      if (packed) {
        engine = begin(packed);
        return;
      }
      try {
        const its = await engine;
        its.command = (sample, commands) => command(its, sample, commands);
        const words = new TextEncoder().encode(`${JSON.stringify(request)}\0`), at = its._malloc(words.length);
        its.HEAPU8.set(words, at);
        const answer = its.UTF8ToString(its._bbsim_answer(at));
        its._free(at);
        const arrays = Array.from({length: its._bbsim_arrays()}, (_, i) => {
          const from = its._bbsim_array(i) / 8;
          return its.HEAPF64.slice(from, from + its._bbsim_size(i));
        });
        postMessage({id, answer, arrays}, arrays.map((one) => one.buffer));
      } catch (error) {
        const words = String(error && error.message || error);
        postMessage({id, fault: /bad_alloc|memory|WebAssembly\.Exception/.test(words) ? 'there is not enough memory: ask for fewer rows or a shorter run' : words});
      }
    };
  }

  let worker = null, asked = 0, controller = '';
  const waiting = new Map();
  function start() {
    // The controller comes first, so that its lines have their numbers.
    const lines = controller ? controller.split('\n').length : 0;
    const url = URL.createObjectURL(new Blob([controller, '\n', textOf('bbsim-engine-loader'), `\n(${work})(${lines});`], {type: 'text/javascript'}));
    worker = new Worker(url);
    worker.onmessage = ({data: {id, answer, arrays, fault}}) => {
      const {resolve, reject} = waiting.get(id);
      waiting.delete(id);
      URL.revokeObjectURL(url);
      if (fault) {
        reject(new Error(fault));
        stop(fault);  // nobody knows what state it is in
        return;
      }
      const its = JSON.parse(answer), {faults} = its;
      if (faults) reject(Object.assign(new Error(faults.map(({message}) => message).join('\n')), {faults}));
      else resolve({answer: its, arrays});
    };
    worker.onerror = (event) => stop(event.lineno > 0 && event.lineno <= lines
        ? `the controller of this page, line ${event.lineno}: ${event.message.replace(/^Uncaught /, '')}`
        : event.message || 'this browser does not run the engine');
    worker.postMessage({packed: textOf('bbsim-engine')});
  }
  // Ends the worker; all that wait for it fail.
  function stop(why) {
    if (worker) worker.terminate();
    worker = null;
    for (const {reject} of waiting.values()) reject(new Error(why));
    waiting.clear();
  }

  return {
    start() { if (!worker) start(); },
    stop,
    // Takes the text of a controller, a script with step(sample) and perhaps reset(); '' for none. It
    // runs in a new worker, so that nothing of an earlier one is left.
    control(script) {
      stop('the controller has changed');
      controller = script;
    },
    // Fulfilled with {answer, arrays}, in the order of the calls; rejected with an error with the answer's
    // `faults` [{place, message}], if it has any.
    ask(request) {
      if (!worker) start();
      return new Promise((resolve, reject) => {
        waiting.set(++asked, {resolve, reject});
        worker.postMessage({id: asked, request});
      });
    },
  };
};
