import { defineConfig } from '@playwright/test';
import base from './playwright.config.ts';

/** `npm run pictures`: takes the pictures of the documentation from the built page. */
export default defineConfig(base, { testMatch: 'pictures.ts', use: { deviceScaleFactor: 1 } });
