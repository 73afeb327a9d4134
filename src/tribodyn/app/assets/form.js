// The form of a case, drawn from data: every field with its label, unit, help and message. What is
// typed goes to the server a moment later, and the server returns the messages of each field.
const PAUSE = 250; // ms
let last = 0;
const number = () => (last = Math.max(last + 1, Date.now()));
const set = (id, data) => window.dash_clientside.set_props(id, { data });

const make = (tag, attributes = {}, ...children) => {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null));
  return node;
};

// Edits are sent with those just before, so that none is lost where two fall together.
const edits = [];
const send = (edit) => {
  edits.push({ ...edit, number: number() });
  edits.splice(0, edits.length - 20);
  set("edit", [...edits]);
};

class Field {
  constructor(data, form) {
    this.key = data.key;
    this.form = form;
    this.id = `${form}-${data.key.replaceAll(".", "-")}`;
    this.shape = shapeOf(data);
    const [letter, index] = data.symbol;
    const symbol = letter ? make("i", {}, letter, index ? make("sub", {}, index) : null) : null;
    const label = make("label", { for: this.id }, data.label, symbol ? " " : null, symbol);
    this.input = this.makeInput(data);
    this.unit = data.units.length > 1 ? this.makeUnit(data) : null;
    const printed = data.units.length === 1 ? make("span", { class: "unit" }, data.units[0]) : null;
    this.fault = make("p", { class: "fault", id: `${this.id}-fault` });
    this.help = make("p", { class: "help", id: `${this.id}-help` });
    this.row = make("div", { class: "field" }, label,
      make("div", { class: "value" }, this.input, this.unit ?? printed), this.fault, this.help);
    this.update(data, "");
  }

  makeInput(data) {
    const common = { id: this.id, "aria-describedby": `${this.id}-fault ${this.id}-help` };
    if (data.kind === "choice") {
      const options = data.names.map(([name, text]) => make("option", { value: name }, text));
      const input = make("select", common, ...options);
      input.addEventListener("change", () => this.tell());
      return input;
    }
    const input = make("input", { ...common, type: "text", autocomplete: "off", spellcheck: "false",
      inputmode: data.kind === "integer" ? "numeric" : null });
    input.addEventListener("input", () => {
      clearTimeout(this.timer);
      this.timer = setTimeout(() => this.tell(), PAUSE);
    });
    input.addEventListener("change", () => this.timer && this.tell());
    return input;
  }

  makeUnit(data) {
    const options = data.units.map((unit) => make("option", { value: unit }, printable(unit)));
    const unit = make("select", { class: "unit", "aria-label": `Unit of ${data.label}` }, ...options);
    unit.addEventListener("change", () => send({ form: this.form, key: this.key, unit: unit.value }));
    return unit;
  }

  tell() {
    clearTimeout(this.timer);
    this.timer = null;
    const unit = this.unit ? this.unit.value : null;
    send({ form: this.form, key: this.key, value: this.input.value, unit });
  }

  update(data, fault) {
    const typing = document.activeElement === this.input && data.kind !== "choice";
    if (!typing && !this.timer) this.input.value = data.value;
    if (data.kind !== "choice") this.input.placeholder = data.placeholder;
    if (this.unit && document.activeElement !== this.input) this.unit.value = data.unit;
    this.row.classList.toggle("default", data.value === "");
    this.row.classList.toggle("wrong", fault !== "");
    this.input.setAttribute("aria-invalid", String(fault !== ""));
    if (this.fault.textContent !== fault) this.fault.textContent = fault;
    this.help.textContent = data.help;
  }
}

const PRINTED = [["^2", "²"], ["^3", "³"], ["^4", "⁴"], ["^-1", "⁻¹"], ["*", "·"], ["degC", "°C"], ["deg", "°"]];
const printable = (unit) => {
  for (const [plain, printed] of PRINTED) unit = unit.replaceAll(plain, printed);
  return unit.replace(/\bum\b/g, "µm");
};
const shapeOf = (data) => JSON.stringify([data.key, data.kind, data.units, data.names, data.label]);

class Form {
  constructor(name) {
    this.name = name;
    this.fields = new Map();
    this.open = new Map(); // which tables the reader has opened or closed
    this.shape = "";
  }

  render(place, data) {
    const shape = JSON.stringify(data.groups.map(function shapes(group) {
      return [group.key, group.fields.map(shapeOf), group.more.map(shapeOf), group.groups.map(shapes)];
    }));
    if (shape !== this.shape || !place.hasChildNodes()) this.build(place, data, shape);
    const faults = new Map(data.faults.map((fault) => [fault.key, fault.text]));
    const every = [];
    const collect = (group) => {
      every.push(...group.fields, ...group.more);
      group.groups.forEach(collect);
      const part = (name) => document.getElementById(`${this.name}-${name}-${group.key}`);
      const note = part("note");
      if (note) note.textContent = group.note;
      const values = part("values");
      if (values) values.textContent = group.values ? `${group.values} value${group.values > 1 ? "s" : ""}` : "";
      const inside = (each) => [...each.fields, ...each.more].some((field) => faults.has(field.key))
        || each.groups.some(inside);
      part("table")?.classList.toggle("wrong", inside(group));
    };
    data.groups.forEach(collect);
    for (const each of every) this.fields.get(each.key).update(each, faults.get(each.key) ?? "");
    this.tellFaults(data.faults);
  }

  build(place, data, shape) {
    const focused = document.activeElement?.id;
    this.shape = shape;
    this.fields.clear();
    this.faults = make("div", { class: "faults", role: "alert" });
    place.replaceChildren(this.faults, ...data.groups.map((group) => this.group(group)));
    if (focused && !document.activeElement?.id) document.getElementById(focused)?.focus();
  }

  group(data) {
    const rows = (list) => list.map((each) => {
      const field = new Field(each, this.name);
      this.fields.set(each.key, field);
      return field.row;
    });
    const twins = data.groups.length === 2 && data.groups[0].fields.length > 0;
    const inner = data.groups.map((group) => this.group(group));
    const folded = data.more.length
      ? this.details(`${data.key}:more`, false, { class: "more" },
        make("summary", {}, `More (${data.more.length})`), ...rows(data.more)) : null;
    const fields = make("div", { class: "fields" }, ...rows(data.fields));
    const within = make("div", { class: twins ? "twins" : "inner" }, ...inner);
    const note = make("span", { class: "note", id: `${this.name}-note-${data.key}` }, data.note);
    const values = make("span", { class: "values", id: `${this.name}-values-${data.key}`,
      title: "Values of the case in this box; all others have their defaults" });
    const head = make("summary", { id: `${this.name}-table-${data.key}` }, make("span", { class: "title" }, data.title),
      make("span", { class: "meaning" }, data.meaning), note, values);
    return this.details(data.key, data.open, { class: "group" }, head, fields, within, folded);
  }

  details(key, open, attributes, ...children) {
    const node = make("details", { ...attributes, open: this.open.get(key) ?? open }, ...children);
    node.addEventListener("toggle", () => this.open.set(key, node.open));
    return node;
  }

  tellFaults(faults) {
    const text = JSON.stringify(faults);
    if (this.faults.dataset.faults === text) return;
    this.faults.dataset.faults = text;
    const items = faults.map((fault) => {
      const to = make("button", { type: "button", class: "link" }, fault.label || "Case");
      to.addEventListener("click", () => this.show(fault.key));
      return make("li", {}, to, " ", fault.text);
    });
    const count = faults.length === 1 ? "One value is invalid" : `${faults.length} values are invalid`;
    this.faults.replaceChildren(...(items.length ? [make("p", {}, count), make("ul", {}, ...items)] : []));
  }

  show(key) {
    const field = this.fields.get(key);
    if (!field) return;
    for (let node = field.row; node; node = node.parentElement) if (node.tagName === "DETAILS") node.open = true;
    field.input.focus();
  }
}

const forms = { case: new Form("case"), study: new Form("study") };
let known = {};
const draw = () => {
  for (const [name, form] of Object.entries(forms)) {
    const place = document.getElementById(`${name}-form`);
    if (place && known[name]) form.render(place, known[name]);
  }
};
new MutationObserver(() => {
  for (const name of Object.keys(forms)) {
    const place = document.getElementById(`${name}-form`);
    if (place && known[name] && !place.hasChildNodes()) forms[name].render(place, known[name]);
  }
}).observe(document.documentElement, { childList: true, subtree: true });

// A message that all is well leaves by itself; one about a fault stays until it is closed.
const STAY = 7000; // ms
let leaving = null;
const closeNotice = () => document.getElementById("notice")?.classList.add("gone");
const watchNotice = (place) => new MutationObserver(() => {
  clearTimeout(leaving);
  place.classList.remove("gone");
  const leave = () => {
    if (place.matches(":hover")) leaving = setTimeout(leave, 1000);
    else closeNotice();
  };
  if (place.querySelector("p.good")) leaving = setTimeout(leave, STAY);
}).observe(place, { childList: true, subtree: true, attributeFilter: ["data-number"] });
const awaitNotice = new MutationObserver(() => {
  const place = document.getElementById("notice");
  if (!place) return;
  awaitNotice.disconnect();
  place.addEventListener("click", closeNotice);
  watchNotice(place);
});
awaitNotice.observe(document.documentElement, { childList: true, subtree: true });

// Everything that can be pressed says what it does; the text of a related field is sent with it.
const act = (button) => {
  const { do: what, of, from } = button.dataset;
  const text = from ? document.getElementById(from)?.value ?? "" : "";
  for (const form of Object.values(forms)) for (const field of form.fields.values()) if (field.timer) field.tell();
  set("act", { do: what, of: of ?? "", text, number: number() });
};
document.addEventListener("click", (event) => {
  const button = event.target.closest("[data-do]");
  if (button && !button.disabled) act(button);
});
document.addEventListener("keydown", (event) => {
  if (event.key === "Escape") closeNotice();
  if (event.key === "Enter" && event.target.dataset?.enter) act(document.getElementById(event.target.dataset.enter));
  if (event.key === "Enter" && event.ctrlKey) document.querySelector('[data-do="run"]')?.click();
  // Arrow keys go along a row of tabs.
  const tabs = event.target.closest?.('[role="tablist"]');
  const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (!tabs || !step) return;
  const all = [...tabs.querySelectorAll('[role="tab"]')];
  const next = all[(all.indexOf(event.target) + step + all.length) % all.length];
  next.focus();
  next.click();
});

window.dash_clientside = Object.assign({}, window.dash_clientside, {
  tribodyn: {
    render: (data) => {
      known = data ?? {};
      draw();
    },
    // The next look comes after the answer to the last one, however long that took.
    pulse: (pulse) => {
      if (pulse?.busy) setTimeout(() => set("tick", pulse.count + 1), 400);
    },
  },
});
