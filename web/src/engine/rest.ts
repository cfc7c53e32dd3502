import type { SecondModule } from '@knead/wasi';

type Stand = (...numbers: (number | bigint)[]) => unknown;

/**
 * The functions of the engine that a typical session does not call, in a module of their own (scripts/split.mjs). The core
 * imports a stand-in for each, named by its place in the core's table; the first call of one starts the second module, which
 * puts its functions into that table. So far as the library can see nothing is missing.
 */
export class Rest implements SecondModule {
  private compiled: WebAssembly.Module | null = null;
  private core: WebAssembly.Exports | null = null;
  private begun = false;

  /** `compile`: for a call that comes before the module was provided; it has to wait. */
  constructor(private readonly compile: () => WebAssembly.Module) {}

  /** Whether one of its functions was called. */
  get started(): boolean {
    return this.begun;
  }

  /** The module, compiled ahead. */
  provide(module: WebAssembly.Module): void {
    this.compiled ??= module;
  }

  /** What it is to belong to, once that has started. */
  join(core: WebAssembly.Exports): void {
    this.core = core;
  }

  standIn(place: string): Stand {
    return (...numbers) => {
      const core = this.core!;
      if (!this.begun) new WebAssembly.Instance(this.compiled ??= this.compile(), { core });
      this.begun = true;
      const table = Object.values(core).find((e) => e instanceof WebAssembly.Table) as WebAssembly.Table;
      return (table.get(Number(place)) as Stand)(...numbers);
    };
  }
}
