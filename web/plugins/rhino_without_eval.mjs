/**
 * Vite plugin. The glue code of rhino3dm makes functions out of text (`new Function`), which the page's policy forbids,
 * rightly. The four places that do are replaced by closures that do the same. A version of rhino3dm that is made
 * differently stops the build.
 */
const replacements = {
  createNamedFunction: `function createNamedFunction(name, body) {
    const named = function () { return body.apply(this, arguments); };
    return Object.defineProperty(named, 'name', { value: makeLegalFunctionName(name) });
  }`,
  craftInvokerFunction: `function craftInvokerFunction(name, types, classType, invoker, target) {
    const count = types.length - 2;
    if (count < 0) throwBindingError(name + ' has no return type');
    const [result, self] = types;
    const isMethod = self !== null && classType !== null;
    const collects = types.slice(1).some((t) => t !== null && t.destructorFunction === undefined);
    return function (...given) {
      if (given.length !== count) throwBindingError('function ' + name + ' called with ' + given.length + ' arguments, expected ' + count + ' args!');
      const owed = collects ? [] : null;
      const wired = isMethod ? [self.toWireType(owed, this)] : [];
      for (let k = 0; k < count; ++k) wired.push(types[k + 2].toWireType(owed, given[k]));
      const value = invoker(target, ...wired);
      if (owed) runDestructors(owed);
      else {
        const own = isMethod ? types.slice(1) : types.slice(2);
        own.forEach((t, k) => { if (t.destructorFunction !== null) t.destructorFunction(wired[k]); });
      }
      if (result.name !== 'void') return result.fromWireType(value);
    };
  }`,
  craftEmvalAllocator: `function craftEmvalAllocator(count) {
    return function (constructor, types, at) {
      const values = [];
      for (let k = 0; k < count; ++k) {
        const type = requireRegisteredType(HEAPU32[types >> 2], 'parameter ' + k);
        values.push(type.readValueFromPointer(at));
        at += type.argPackAdvance;
        types += 4;
      }
      return Emval.toHandle(new constructor(...values));
    };
  }`,
  __emval_get_method_caller: `function __emval_get_method_caller(count, typesAt) {
    const [result, ...types] = emval_lookupTypes(count, typesAt);
    const signature = result.name + '_$' + types.map((t) => t.name).join('_') + '$';
    if (emval_registeredMethods[signature] !== undefined) return emval_registeredMethods[signature];
    const id = emval_addMethodCaller(function (handle, name, destructors, at) {
      const values = types.map((t) => {
        const value = t.readValueFromPointer(at);
        at += t.argPackAdvance;
        return value;
      });
      const value = handle[name](...values);
      types.forEach((t, k) => { if (t.deleteObject) t.deleteObject(values[k]); });
      if (!result.isVoid) return result.toWireType(destructors, value);
    });
    emval_registeredMethods[signature] = id;
    return id;
  }`,
};

/** [from, to) of a function declaration; its braces balance, in its strings too. */
function declaration(code, name) {
  const from = code.indexOf(`function ${name}(`);
  if (from < 0) throw new Error(`rhino3dm: there is no function ${name} any more`);
  let depth = 0;
  for (let k = code.indexOf('{', from); k < code.length; ++k) {
    if (code[k] === '{') ++depth;
    if (code[k] === '}' && --depth === 0) return [from, k + 1];
  }
  throw new Error(`rhino3dm: function ${name} does not end`);
}

export function withoutEval(code, forNode) {
  for (const [name, text] of Object.entries(replacements)) {
    const [from, to] = declaration(code, name);
    code = code.slice(0, from) + text + code.slice(to);
  }
  // What only node needs would be looked for in the browser.
  if (!forNode) code = code.replace('new URL("./",import.meta.url)', '"."').replace('await import("module")', 'await Promise.reject(new Error("not in node"))');
  if (/new Function|new_\(Function|\beval\(/.test(code)) throw new Error('rhino3dm still makes code out of text');
  return code;
}

export const rhinoWithoutEval = ({ forNode = false } = {}) => ({
  name: 'rhino-without-eval',
  transform: (code, id) => (/rhino3dm[\\/]rhino3dm\.module\.js$/.test(id) ? { code: withoutEval(code, forNode), map: null } : null),
});
