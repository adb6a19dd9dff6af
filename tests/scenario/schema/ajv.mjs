// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause
//
// ajv judges the scenarios as python3-jsonschema does: node ajv.mjs BBSIM CASES
// CASES is the output of test_schema.py --cases. Needs ajv (npm install ajv) in a folder of NODE_PATH or above this one.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const Ajv = createRequire(import.meta.url)("ajv").default;
const [program, cases] = process.argv.slice(2);
const schema = JSON.parse(execFileSync(program, ["--schema"], { encoding: "utf8", maxBuffer: 1e8 }));
// Strict about the schema itself: no keyword unknown to ajv.
const validate = new Ajv({ strict: true, strictTypes: false, strictRequired: false, allErrors: false }).compile(schema);

let wrong = 0;
const counts = {};
for (const { name, kind, scenario } of JSON.parse(readFileSync(cases, "utf8"))) {
  counts[kind] = (counts[kind] ?? 0) + 1;
  const accepted = validate(scenario);
  if (accepted !== (kind !== "both")) {
    wrong += 1;
    const why = accepted ? "" : `: ${JSON.stringify(validate.errors[0])}`;
    console.log(`the schema ${accepted ? "accepts" : "refuses"} ${name}${why}`);
  }
}
console.log(`${counts.shipped} accepted, ${counts.both} refused by both, ${counts.program_alone} by the program alone`);
process.exit(wrong ? 1 : 0);
