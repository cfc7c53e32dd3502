declare module 'rhino3dm/rhino3dm.module.js' {
  export default function rhino3dm(config: object): Promise<unknown>;
}
