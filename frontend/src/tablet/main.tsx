import { mountPage } from "@shared/ui/Page";
import { translations } from "./i18n";
import { Tablet } from "./Tablet";

mountPage({ translations, scale: 1.125, children: <Tablet /> });
