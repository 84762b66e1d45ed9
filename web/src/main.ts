/** The page's entry: small, so that the core begins early. The rest of the page comes while it loads. */

import './style/tokens.css';
import './style/layout.css';
import './style/controls.css';
import './style/messages.css';
import './style/measure.css';
import './style/panels.css';
import './style/inspector.css';
import './style/ground.css';
import './style/small.css';
import { core } from './boot/startCore.ts';

if (document.readyState === 'loading') {
  await new Promise((resolve) => document.addEventListener('DOMContentLoaded', resolve, { once: true }));
}
// Hidden until now: browsers lay every form out for their filling-in as soon as it is read, and again with its styles.
document.getElementById('app')?.removeAttribute('hidden');
// Making the page takes longer than starting the core's thread, which then loads beside it.
await core.started;
await import('./boot/page.ts');
