// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The engine of a live page: bbsim itself as WebAssembly, in a worker without network. wasm/engine.cpp
// describes requests and answers.
bbsim.makeEngine = () => {
  const textOf = (id) => document.getElementById(id).textContent;

  // The worker's own code, after the script that loads the module.
  function work() {
    const begin = async (packed) => {
      const bytes = Uint8Array.from(atob(packed), (c) => c.charCodeAt(0));
      const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
      return bbsimEngine({wasmBinary: await new Response(unpacked).arrayBuffer()});
    };
    // Calls step(sample) of the viewer's controller for wasm/engine.cpp, whose numbers these are.
    function command(its, n, commands) {
      try {
        const pair = (i) => [n[i], n[i + 1]];
        const given = step({sample: n[0], t: n[1], ball: n[2] ? pair(3) : null, reference: pair(5), reference_rate: pair(7),
                            reference_acceleration: pair(9), servo: pair(11), servo_rate: pair(13), period: n[15]});
        const pairOf = Array.isArray(given) ? given : given && given.command;
        if (!Array.isArray(pairOf) || pairOf.length !== 2 || !pairOf.every(Number.isFinite)) {
          throw new Error(`step() returned ${JSON.stringify(given)}; allowed: [phi, theta], two finite numbers`);
        }
        commands.set(pairOf);
        return 0;
      } catch (error) {
        const [, line] = /blob:[^)\s]*?:(\d+):\d+/.exec(error && error.stack || '') || [];
        its.fault = `the controller of this page${line && error.name !== 'Error' ? `, line ${line}` : ''}: ${error && error.message || error}`;
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
        if (request.controlled && typeof reset === 'function') reset();
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
        postMessage({id, fault: String(error && error.message || error)});
      }
    };
  }

  let worker = null, asked = 0, controller = '';
  const waiting = new Map();
  function start() {
    // The controller comes first, so that its lines have their numbers.
    const url = URL.createObjectURL(new Blob([controller, '\n', textOf('bbsim-engine-loader'), `\n(${work})();`], {type: 'text/javascript'}));
    const lines = controller.split('\n').length;
    worker = new Worker(url);
    worker.onmessage = ({data: {id, answer, arrays, fault}}) => {
      const {resolve, reject} = waiting.get(id);
      waiting.delete(id);
      if (fault) reject(new Error(fault));
      else resolve({answer: JSON.parse(answer), arrays});
    };
    worker.onerror = (event) => stop(controller && event.lineno <= lines
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
    // Fulfilled with {answer, arrays}, in the order of the calls.
    ask(request) {
      if (!worker) start();
      return new Promise((resolve, reject) => {
        waiting.set(++asked, {resolve, reject});
        worker.postMessage({id: asked, request});
      });
    },
  };
};
