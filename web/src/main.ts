/** The page's entry: small, so that the core begins early. The rest of the page comes while it loads. */

import './style/tokens.css';
import './style/layout.css';
import './style/controls.css';
import './style/measure.css';
import './style/panels.css';
import './style/thinking.css';
import './style/ground.css';
import './early.ts';

if (document.readyState === 'loading') {
  await new Promise((resolve) => document.addEventListener('DOMContentLoaded', resolve, { once: true }));
}
await import('./page.ts');
