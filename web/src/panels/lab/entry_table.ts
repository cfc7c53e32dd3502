import { format } from '../../document/units';
import { h } from '../dom';
import type { BandTable } from './heat_map';
import type { Highlight } from './model';
import { exact, tiny } from './names';

const cellWidth = 78;
const headWidth = 34;
const rowHeight = 21;

/** The numbers of a matrix: only visible ones are in the page. Arrow keys move from entry to entry. */
export class EntryTable {
  private readonly head = h('thead');
  private readonly body = h('tbody');
  private readonly grid = h('table', { class: 'lab-table', tabIndex: 0, role: 'grid', aria: { label: 'Entries of the Gramian' } }, this.head, this.body);
  private readonly extent = h('div', { class: 'lab-extent' }, this.grid);
  readonly element = h('div', { class: 'lab-scroll' }, this.extent);

  private table: BandTable = { size: 0, bandwidth: 0, values: new Float64Array() };
  private small = false;
  private selected: Highlight = { i: 0, j: 0 };
  private highlight: Highlight | null = null;
  private readonly observer = new ResizeObserver(() => this.draw());

  constructor(private readonly point: (at: Highlight | null) => void) {
    this.element.addEventListener('scroll', () => this.draw());
    this.observer.observe(this.element);
    this.grid.addEventListener('pointermove', (e) => this.point(cellOf(e.target)));
    this.grid.addEventListener('pointerleave', () => this.point(null));
    this.grid.addEventListener('click', (e) => {
      const at = cellOf(e.target);
      if (at) this.select(at);
    });
    this.grid.addEventListener('keydown', (e) => this.key(e));
    this.grid.addEventListener('focus', () => this.point(this.selected));
  }

  close(): void {
    this.observer.disconnect();
  }

  /** Small numbers, of differences, are shown with two digits. */
  show(table: BandTable, small: boolean): void {
    this.table = table;
    this.small = small;
    this.selected = { i: Math.min(this.selected.i, table.size - 1), j: Math.min(this.selected.j, table.size - 1) };
    this.extent.style.width = `${headWidth + table.size * cellWidth}px`;
    this.extent.style.height = `${(table.size + 1) * rowHeight}px`;
    this.grid.setAttribute('aria-rowcount', String(table.size + 1));
    this.grid.setAttribute('aria-colcount', String(table.size + 1));
    this.draw();
  }

  light(highlight: Highlight | null): void {
    this.highlight = highlight;
    for (const cell of this.grid.querySelectorAll<HTMLElement>('td, th')) this.mark(cell);
  }

  select(at: Highlight): void {
    this.selected = at;
    this.reveal(at);
    this.draw();
    this.point(at);
  }

  /** Scrolls until an entry is visible. */
  reveal(at: Highlight): void {
    const { element } = this;
    const [left, top] = [at.j * cellWidth, at.i * rowHeight];
    const [across, down] = [element.clientWidth - headWidth, element.clientHeight - rowHeight];
    if (left < element.scrollLeft) element.scrollLeft = left;
    else if (left + cellWidth > element.scrollLeft + across) element.scrollLeft = left + cellWidth - across;
    if (top < element.scrollTop) element.scrollTop = top;
    else if (top + rowHeight > element.scrollTop + down) element.scrollTop = top + rowHeight - down;
  }

  value(i: number, j: number): number {
    const { size, bandwidth: p, values } = this.table;
    return i < 0 || j < 0 || i >= size || j >= size || Math.abs(i - j) > p ? 0 : values[i * (2 * p + 1) + j - i + p]!;
  }

  private draw(): void {
    const { size: n, bandwidth: p } = this.table;
    const rows = Math.min(n, Math.ceil(Math.max(0, this.element.clientHeight - rowHeight) / rowHeight) + 1);
    const columns = Math.min(n, Math.ceil(Math.max(0, this.element.clientWidth - headWidth) / cellWidth) + 1);
    const top = Math.min(n - rows, Math.round(this.element.scrollTop / rowHeight));
    const left = Math.min(n - columns, Math.round(this.element.scrollLeft / cellWidth));
    fill(this.head, 1, columns, 'th');
    fill(this.body, rows, columns, 'td');
    const heads = this.head.rows[0]!.cells;
    heads[0]!.textContent = '';
    for (let c = 0; c < columns; ++c) label(heads[c + 1]!, left + c, 'col');
    for (let r = 0; r < rows; ++r) {
      const row = this.body.rows[r]!;
      const i = top + r;
      row.setAttribute('aria-rowindex', String(i + 2));
      label(row.cells[0]!, i, 'row');
      for (let c = 0; c < columns; ++c) {
        const j = left + c;
        const cell = row.cells[c + 1]!;
        const inside = Math.abs(i - j) <= p;
        const value = this.value(i, j);
        const text = inside ? (this.small ? tiny(value) : format(value)) : '';
        const title = inside ? exact(value) : '';
        if (cell.textContent !== text) cell.textContent = text;
        if (cell.title !== title) cell.title = title;
        const id = `lab-entry-${i}-${j}`;
        if (cell.id !== id) {
          cell.id = id;
          cell.dataset.i = String(i);
          cell.dataset.j = String(j);
          cell.setAttribute('role', 'gridcell');
          cell.setAttribute('aria-colindex', String(j + 2));
        }
        this.mark(cell);
      }
    }
    this.grid.setAttribute('aria-activedescendant', `lab-entry-${this.selected.i}-${this.selected.j}`);
  }

  private mark(cell: HTMLElement): void {
    const { highlight, selected } = this;
    const i = cell.dataset.i === undefined ? -1 : Number(cell.dataset.i);
    const j = cell.dataset.j === undefined ? -1 : Number(cell.dataset.j);
    const row = highlight !== null && highlight.i === i;
    const column = highlight !== null && highlight.j === j;
    cell.classList.toggle('cross', (row || column) && !(row && column));
    cell.classList.toggle('lit', row && column);
    const chosen = String(i === selected.i && j === selected.j);
    if (cell.tagName === 'TD' && cell.getAttribute('aria-selected') !== chosen) cell.setAttribute('aria-selected', chosen);
  }

  private key(event: KeyboardEvent): void {
    const { size: n } = this.table;
    const by = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1], PageUp: [-8, 0], PageDown: [8, 0], Home: [0, -n], End: [0, n] }[event.key];
    const clamp = (x: number) => Math.min(n - 1, Math.max(0, x));
    if (by) this.select({ i: clamp(this.selected.i + by[0]!), j: clamp(this.selected.j + by[1]!) });
    else if (event.key.toLowerCase() === 'c' && (event.ctrlKey || event.metaKey) && getSelection()?.isCollapsed !== false) {
      void navigator.clipboard?.writeText(exact(this.value(this.selected.i, this.selected.j)));
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

function cellOf(target: EventTarget | null): Highlight | null {
  const cell = (target as Element | null)?.closest<HTMLElement>('td[data-i]');
  return cell ? { i: Number(cell.dataset.i), j: Number(cell.dataset.j) } : null;
}

function label(cell: HTMLTableCellElement, index: number, scope: 'row' | 'col'): void {
  if (cell.textContent === String(index) && cell.scope === scope) return;
  cell.textContent = String(index);
  cell.scope = scope;
  cell.dataset[scope === 'row' ? 'i' : 'j'] = String(index);
}

/** As many rows and cells as needed, each after a heading. */
function fill(part: HTMLTableSectionElement, rows: number, columns: number, kind: 'td' | 'th'): void {
  while (part.rows.length > rows) part.deleteRow(-1);
  while (part.rows.length < rows) part.append(h('tr', {}, h('th')));
  for (const row of part.rows) {
    while (row.cells.length > columns + 1) row.deleteCell(-1);
    while (row.cells.length < columns + 1) row.append(document.createElement(kind));
  }
}
