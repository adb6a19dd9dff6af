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
    let engine = null;
    onmessage = async ({data: {packed, id, request}}) => {
      if (packed) {
        engine = begin(packed);
        return;
      }
      try {
        const its = await engine;
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

  let worker = null, asked = 0;
  const waiting = new Map();
  function start() {
    const url = URL.createObjectURL(new Blob([textOf('bbsim-engine-loader'), `\n(${work})();`], {type: 'text/javascript'}));
    worker = new Worker(url);
    worker.onmessage = ({data: {id, answer, arrays, fault}}) => {
      const {resolve, reject} = waiting.get(id);
      waiting.delete(id);
      if (fault) reject(new Error(fault));
      else resolve({answer: JSON.parse(answer), arrays});
    };
    worker.onerror = (event) => stop(event.message || 'this browser does not run the engine');
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
