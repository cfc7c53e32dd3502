import { format, parseNumber } from '../document/units';
import { h } from './dom';

/** Why a number cannot be; nothing where it is taken. */
type Answer = string | null | void | Promise<string | null>;

let count = 0;

/** Takes the mark of a refused text away. */
function clear(control: HTMLElement): void {
  control.removeAttribute('aria-invalid');
  control.classList.remove('wrong');
  const id = control.getAttribute('aria-describedby');
  control.removeAttribute('aria-describedby');
  if (id) document.getElementById(id)?.remove();
}

/** Says beside a control why what was typed is not taken. Once it is left the control shows what holds. */
export function refuse(control: HTMLInputElement | HTMLTextAreaElement, why: string, valid: string): void {
  clear(control);
  const message = h('p', { class: 'refusal', id: `refusal-${++count}`, role: 'alert' }, why);
  (control.closest('.field') ?? control).after(message);
  control.setAttribute('aria-describedby', message.id);
  const away = document.activeElement !== control;
  if (away) {
    control.value = valid;
    control.addEventListener('input', () => clear(control), { once: true });
    return;
  }
  control.setAttribute('aria-invalid', 'true');
  control.classList.add('wrong');
  control.addEventListener('blur', () => {
    clear(control);
    control.value = valid;
  }, { once: true });
}

/**
 * A number that takes effect when the user leaves it or presses Enter. `parse` may know units. Where `change` answers why
 * the number cannot be, the field is marked.
 */
export function numberInput(label: string, value: number | null, change: (value: number) => Answer,
                            parse: (text: string) => number | null = parseNumber, absent = 'varies'): HTMLInputElement {
  let valid = value === null ? '' : format(value);
  let tried = valid;
  const input = h('input', { class: 'number', type: 'text', inputMode: 'decimal', value: valid, spellcheck: false,
    autocomplete: 'off', placeholder: value === null ? absent : '', aria: { label } });
  const take = async (): Promise<void> => {
    if (input.value === tried && !input.hasAttribute('aria-invalid')) return;
    const text = (tried = input.value);
    const typed = parse(text);
    const why = typed === null ? `“${text}” is not a number here` : await change(typed);
    if (why) refuse(input, why, valid);
    else {
      clear(input);
      valid = format(typed!);
    }
    if (why || document.activeElement !== input) tried = valid;
  };
  input.addEventListener('focus', () => (tried = valid = input.value));
  input.addEventListener('change', () => void take());
  input.addEventListener('keydown', (e) => {
    if (e.key === 'Enter') {
      void take().then(() => {
        if (!input.hasAttribute('aria-invalid')) input.blur();
      });
    }
    if (e.key === 'Escape') {
      clear(input);
      input.value = tried = valid;
      input.blur();
    }
    e.stopPropagation();
  });
  return input;
}
