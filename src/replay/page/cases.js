// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Many runs of a live page's scenario, in a worker of their own: in blocks of some tenths of a
// second, so that a newer wish ends an older one.
bbsim.makeCases = () => {
  const {ask} = bbsim.makeEngine();

  // One picture's runs; each begin() ends those before. `status` tells of them as "100 rigs".
  function makeSeries(status, noun) {
    let turn = 0;
    return {
      end() { ++turn; },
      // Runs a case for each value of the keys ({key: [values]}). `take(first, status, columns,
      // measures)` gets each block, and `paint()` follows when there is something to see. Fulfilled
      // with whether all cases were run.
      async begin(request, {keys, columns = [], measures = []}, take, paint) {
        const mine = ++turn, names = Object.keys(keys), count = keys[names[0]].length, start = performance.now();
        let size = 16, refused = 0, why = null, painted = 0;
        for (let first = 0; first < count;) {
          const upTo = Math.min(first + size, count), begun = performance.now();
          const block = Object.fromEntries(names.map((key) => [key, Array.from(keys[key].slice(first, upTo))]));
          let found;
          try {
            const {answer, arrays} = await ask({...request, cases: {keys: block, columns, measures}});
            const of = (places) => Object.fromEntries(Object.entries(places).map(([name, place]) => [name, arrays[place]]));
            found = [answer.status, of(answer.columns), of(answer.measures)];
          } catch (error) {  // the engine refuses a block if it refuses all its cases
            why = error;
            refused += upTo - first;
            found = [new Array(upTo - first).fill(`refused: ${error.message}`), {}, {}];
          }
          if (mine !== turn) return false;
          take(first, ...found);
          first = upTo;
          const now = performance.now();
          if (now - begun < 100) size = Math.min(2 * size, 512);
          if (now - begun > 400) size = Math.max(8, size >> 1);
          if (first < count && now - painted < 150) continue;
          status.textContent = first < count ? `${first} of ${count} ${noun}` : `${count} ${noun} in ${bbsim.text.number(now - start, 3)} ms`;
          paint();
          painted = performance.now();
        }
        if (refused === count) throw why;
        return true;
      },
    };
  }
  return {ask, makeSeries};
};
