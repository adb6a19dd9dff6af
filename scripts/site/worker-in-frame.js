// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A Worker that runs in a hidden frame: browsers start no worker from a file.
window.Worker = class extends EventTarget {
  constructor(address) {
    super();
    const frame = document.createElement('iframe');
    frame.hidden = true;
    this.waiting = [];
    frame.addEventListener('load', () => {
      const inner = frame.contentWindow;
      // What the script posts goes to the page, not to the frame itself.
      inner.postMessage = (data) => this.tell(data);
      inner.importScripts = () => undefined;
      const script = inner.document.createElement('script');
      script.src = address;
      script.onload = () => {
        this.inner = inner;
        for (const data of this.waiting) this.postMessage(data);
      };
      inner.document.body.append(script);
    }, {once: true});
    const attach = () => document.body.append(frame);
    if (document.body) attach();
    else addEventListener('DOMContentLoaded', attach);
  }

  tell(data) {
    this.dispatchEvent(new MessageEvent('message', {data}));
  }

  postMessage(data) {
    if (!this.inner) this.waiting.push(data);
    else this.inner.dispatchEvent(new MessageEvent('message', {data}));
  }
};
